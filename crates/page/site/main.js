// The page: its picture, and what its user does with it. The worker does the rest.

import { hand, keys } from "./hand.js";
import { panel } from "./panel.js";

const canvas = document.querySelector("#picture");
const context = canvas.getContext("2d", { alpha: false });
const coarse = new OffscreenCanvas(1, 1);
const worker = new Worker("worker.js", { type: "module" });

const act = (name, more = {}) => worker.postMessage({ act: name, ...more });

// Reads a file here: its bytes go to the worker, and nowhere else.
async function open(file) {
  const bytes = await file.arrayBuffer();
  worker.postMessage({ open: file.name, bytes }, [bytes]);
}

// Pixels go into the canvas as they are, or are spread over it while they are fewer.
function show({ width, height, rgba }) {
  const image = new ImageData(new Uint8ClampedArray(rgba.buffer), width, height);
  if (width === canvas.width && height === canvas.height) {
    context.putImageData(image, 0, 0);
    return;
  }
  Object.assign(coarse, { width, height });
  coarse.getContext("2d").putImageData(image, 0, 0);
  context.drawImage(coarse, 0, 0, canvas.width, canvas.height);
}

const tell = panel({ act, open, canvas });

worker.onmessage = ({ data }) => {
  if (data.picture) {
    show(data.picture);
  } else if (data.state) {
    tell(JSON.parse(data.state));
  } else {
    document.querySelector("#notice").textContent = `The viewer has stopped: ${data.broken}`;
  }
};

hand(canvas, act);
keys(canvas, act);

new ResizeObserver(() => {
  const scale = window.devicePixelRatio;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((length) =>
    Math.max(1, Math.round(scale * length)),
  );
  if (width !== canvas.width || height !== canvas.height) {
    const kept = coarse.getContext("2d");
    Object.assign(coarse, { width: canvas.width, height: canvas.height });
    kept.drawImage(canvas, 0, 0);
    Object.assign(canvas, { width, height });
    context.drawImage(coarse, 0, 0, width, height);
  }
  act("resize", { width, height });
}).observe(canvas);

const receives = (is) => document.body.classList.toggle("receiving", is);
document.addEventListener("dragover", (event) => {
  event.preventDefault();
  receives(true);
});
document.addEventListener("dragleave", (event) => receives(event.relatedTarget !== null));
document.addEventListener("drop", (event) => {
  event.preventDefault();
  receives(false);
  const file = event.dataTransfer.files[0];
  if (file) {
    open(file);
  }
});

const molecule = await fetch("molecule.pdb.gz");
if (molecule.ok) {
  await open(new File([await molecule.blob()], "molecule.pdb.gz"));
}
