// What the mouse, a finger and the keyboard do on the picture.

// The share of the distance that is left after one point of scrolling.
const ZOOM = 0.997;

// Milliseconds in which a press that does not move is a click.
const CLICK = 400;

// Heights of the picture that a key turns or moves by, and the share of the distance that is left.
const STEP = 0.04;
const NEARER = 0.9;

// Turns, slides, zooms and picks.
export function hand(canvas, act) {
  let held = null;

  const place = (event) => [event.offsetX / canvas.clientWidth, event.offsetY / canvas.clientHeight];

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held = { x: event.clientX, y: event.clientY, since: event.timeStamp, moved: false };
    act("grab", { at: place(event) });
  });

  canvas.addEventListener("pointermove", (event) => {
    if (!held) {
      return;
    }
    const by = [event.clientX - held.x, event.clientY - held.y].map(
      (points) => points / canvas.clientHeight,
    );
    if (by[0] === 0 && by[1] === 0) {
      return;
    }
    Object.assign(held, { x: event.clientX, y: event.clientY, moved: true });
    act(event.shiftKey || event.buttons !== 1 ? "slide" : "turn", { by });
  });

  canvas.addEventListener("pointerup", (event) => {
    const isClick = held && !held.moved && event.timeStamp - held.since < CLICK;
    held = null;
    act("release");
    if (isClick && event.button === 0) {
      act("pick", { at: place(event), centre: false });
    }
  });

  canvas.addEventListener("pointercancel", () => {
    held = null;
    act("release");
  });

  canvas.addEventListener("dblclick", (event) => act("pick", { at: place(event), centre: true }));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());

  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
      act("zoom", { at: place(event), share: ZOOM ** (-lines * event.deltaY) });
    },
    { passive: false },
  );
}

// The same from the keyboard, where the picture has it.
export function keys(canvas, act) {
  const middle = [0.5, 0.5];
  const ways = {
    ArrowRight: [STEP, 0],
    ArrowLeft: [-STEP, 0],
    ArrowDown: [0, STEP],
    ArrowUp: [0, -STEP],
  };
  const axes = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) {
      return;
    }
    const key = event.key.toLowerCase();
    if (event.key in ways) {
      act(event.shiftKey ? "slide" : "turn", { by: ways[event.key] });
    } else if (key in axes) {
      const sign = event.shiftKey ? -1 : 1;
      act("along", { axis: axes[key].map((part) => sign * part) });
    } else if (key === "+" || key === "=") {
      act("zoom", { at: middle, share: NEARER });
    } else if (key === "-") {
      act("zoom", { at: middle, share: 1 / NEARER });
    } else if (key === "q" || key === "e") {
      act("roll", { by: key === "e" ? STEP : -STEP });
    } else if (key === "h" || key === "home") {
      act("home");
    } else if (key === "escape") {
      act("cancel");
    } else {
      return;
    }
    event.preventDefault();
  });
}
