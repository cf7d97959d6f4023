// Turns a view by mouse, finger and keys: the left button goes around the body, the right one, or two fingers, move the sun,
// the wheel comes nearer. Arrow keys turn, with Shift they move the sun; + and - come nearer.
export function orbit(view, canvas, moved = () => {}) {
  const NEAREST = 1.35, FARTHEST = 14;
  const between = (x, low, high) => Math.min(Math.max(x, low), high);
  const fingers = new Map();
  let pinch = 0;

  function done() {
    view.request();
    moved();
  }
  function turn(dx, dy) {
    const speed = 0.32 * Math.min(1, view.camera.distance / 4);
    view.camera.longitude -= speed * dx;
    view.camera.latitude = between(view.camera.latitude + speed * dy, -88, 88);
    done();
  }
  function moveSun(dx, dy) {
    view.sun.longitude = (view.sun.longitude + 0.45 * dx + 540) % 360 - 180;
    view.sun.latitude = between(view.sun.latitude - 0.35 * dy, -89, 89);
    done();
  }
  function zoom(factor) {
    view.camera.distance = between(view.camera.distance * factor, NEAREST, FARTHEST);
    done();
  }

  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("pointerdown", event => {
    fingers.set(event.pointerId, event);
    canvas.setPointerCapture(event.pointerId);
    pinch = 0;
  });
  canvas.addEventListener("pointermove", event => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    fingers.set(event.pointerId, event);
    const dx = event.clientX - before.clientX, dy = event.clientY - before.clientY;
    if (fingers.size === 1) return (event.buttons & 2 ? moveSun : turn)(dx, dy);
    const [a, b] = [...fingers.values()], apart = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
    if (pinch > 0) zoom(pinch / Math.max(apart, 1));
    pinch = apart;
    moveSun(dx / 2, dy / 2);
  });
  const lifted = event => fingers.delete(event.pointerId);
  ["pointerup", "pointercancel", "lostpointercapture"].forEach(name => canvas.addEventListener(name, lifted));
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    zoom(Math.exp(between(event.deltaY, -120, 120) * 0.0016));
  }, {passive: false});
  canvas.addEventListener("keydown", event => {
    const by = {ArrowLeft: [-18, 0], ArrowRight: [18, 0], ArrowUp: [0, -18], ArrowDown: [0, 18]}[event.key];
    const factor = {"+": 0.9, "=": 0.9, "-": 1 / 0.9}[event.key];
    if (event.ctrlKey || event.metaKey || !by && !factor) return;
    event.preventDefault();
    by ? (event.shiftKey ? moveSun : turn)(...by) : zoom(factor);
  });
}
