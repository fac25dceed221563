// The worker: WebAssembly with the viewer, to which the page tells what its user does.

import init, { Page } from "./page.js";

let page = null;
let timer = 0;
let isDue = false;
let told = "";
const early = [];

function obey(message) {
  if (message.open) {
    page.open(message.open, new Uint8Array(message.bytes));
  } else {
    page.act(JSON.stringify(message));
  }
}

// Shows what there is to be shown, and comes back when the viewer wants it.
function goOn() {
  isDue = false;
  clearTimeout(timer);
  const wait = page.goOn();
  if (wait !== undefined) {
    timer = setTimeout(goOn, wait);
  }
  const picture = page.picture();
  if (picture) {
    const { width, height, rgba } = picture;
    picture.free();
    postMessage({ picture: { width, height, rgba } }, [rgba.buffer]);
  }
  const state = page.state();
  if (state !== told) {
    told = state;
    postMessage({ state });
  }
}

// Once for all that happens in one turn.
function soon() {
  if (!isDue) {
    isDue = true;
    queueMicrotask(goOn);
  }
}

function attempt(what) {
  try {
    what();
  } catch (error) {
    postMessage({ broken: String(error) });
  }
}

self.wake = () => page && soon();

onmessage = ({ data }) => {
  if (!page) {
    early.push(data);
    return;
  }
  attempt(() => {
    obey(data);
    soon();
  });
};

try {
  await init({ module_or_path: new URL("page_bg.wasm", import.meta.url) });
  page = new Page();
  attempt(() => {
    early.forEach(obey);
    goOn();
  });
} catch (error) {
  postMessage({ broken: String(error) });
}
