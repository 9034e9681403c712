// Dragging, pinching, turning the wheel, and keys: all of them call `act`.

/** Half a turn for a drag across the height of the canvas. */
const TURN = 180;
const ZOOM = 1.1;
/** Pixels that a wheel scrolls by one notch. */
const NOTCH = 100;

/**
 * @param act has turn(azimuth, elevation), pan(x, y) and zoom(factor, x, y) in pixels, pick(x, y), rest(),
 * and key actions
 */
function listenToGestures(canvas, act) {
  const pointers = new Map();
  let start = null;

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    const isPan = event.shiftKey || event.button === 2 || event.button === 1;
    // The middle button would scroll.
    if (event.button === 1) event.preventDefault();
    start = { x: event.offsetX, y: event.offsetY, isPan, view: act.begin() };
  });

  canvas.addEventListener("pointermove", (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const now = [event.offsetX, event.offsetY];
    if (pointers.size === 1 && start) {
      if (start.isPan) {
        act.pan(now[0] - last[0], now[1] - last[1]);
      } else {
        // From where the drag began, so that rounding does not add up.
        const degrees = TURN / canvas.clientHeight;
        act.turnTo(start.view, -(now[0] - start.x) * degrees, (now[1] - start.y) * degrees);
      }
    } else if (pointers.size === 2) {
      const [other] = [...pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
      const [before, after] = [last, now].map(([x, y]) => Math.hypot(x - other[0], y - other[1]));
      act.pan((now[0] - last[0]) / 2, (now[1] - last[1]) / 2);
      if (before > 0 && after > 0) act.zoom(after / before, (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
      start = null;
    }
    pointers.set(event.pointerId, now);
  });

  const end = (event) => {
    if (!pointers.delete(event.pointerId)) return;
    start = null;
    if (!pointers.size) act.rest();
  };
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());

  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? NOTCH / 3 : 1;
    // Pinching on a touchpad comes as a wheel with small steps.
    const notches = (-event.deltaY * lines * (event.ctrlKey ? 4 : 1)) / NOTCH;
    act.zoom(ZOOM ** Math.max(-4, Math.min(4, notches)), event.offsetX, event.offsetY);
    act.settle();
  }, { passive: false });

  canvas.addEventListener("dblclick", (event) => act.pick(event.offsetX, event.offsetY));

  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const [middleX, middleY] = [canvas.clientWidth / 2, canvas.clientHeight / 2];
    const step = event.shiftKey ? 1 : 5;
    const keys = {
      ArrowLeft: () => act.turn(step, 0),
      ArrowRight: () => act.turn(-step, 0),
      ArrowUp: () => act.turn(0, -step),
      ArrowDown: () => act.turn(0, step),
      "+": () => act.zoom(ZOOM, middleX, middleY),
      "=": () => act.zoom(ZOOM, middleX, middleY),
      "-": () => act.zoom(1 / ZOOM, middleX, middleY),
      _: () => act.zoom(1 / ZOOM, middleX, middleY),
      1: () => act.show("front"),
      3: () => act.show("right"),
      7: () => act.show("top"),
      0: () => act.show("isometric"),
      5: () => act.toggleProjection(),
      r: () => act.reset(),
      R: () => act.reset(),
      f: () => act.fit(),
      h: () => act.pan(-20, 0),
      l: () => act.pan(20, 0),
      k: () => act.pan(0, -20),
      j: () => act.pan(0, 20),
    };
    const action = keys[event.key];
    if (!action) return;
    event.preventDefault();
    action();
    act.settle();
  });
}
