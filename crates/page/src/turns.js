// Turns of the tasks of a worker.

const { port1, port2 } = new MessageChannel();
const waiting = [];
port1.onmessage = () => waiting.shift()();

// Goes on behind what has been told to the worker meanwhile.
export function turn() {
  return new Promise((goOn) => {
    waiting.push(goOn);
    port2.postMessage(null);
  });
}

// Says that there is something to be shown.
export function wake() {
  self.wake();
}
