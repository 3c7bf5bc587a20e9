// The camera by hand: mouse, touch and keys become cameras.

class Pilot {
  // `steer(camera)` is called for each new camera, `findPivot(x, y)` for a point to turn round. Gestures do
  // nothing until `isPilot`.
  constructor(canvas, steer, findPivot) {
    this.canvas = canvas;
    this.steer = steer;
    this.findPivot = findPivot;
    this.bounds = null;  // of the scene: least and greatest coordinates
    this.isPilot = false;
    this.camera = null;  // shown, or steered to
    this.home = null;
    this.pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, (event) => this.pointers.delete(event.pointerId));
    }
    canvas.addEventListener("wheel", (event) => this.wheel(event), {passive: false});
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("dblclick", (event) => this.choosePivot(event));
  }

  // Asks for the point under the pointer, in shares of the picture.
  choosePivot(event) {
    if (!this.isPilot) return;
    const box = this.canvas.getBoundingClientRect();
    this.findPivot((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
  }

  // Looks at this point, and turns round it from now on.
  turnRound(point) {
    return this.change((camera) => ({...camera, at: point}));
  }

  frameAll() {
    return this.bounds ? this.change(framing, this.bounds, this.canvas.width / this.canvas.height) : false;
  }

  turnTo(camera) {
    if (!this.isPilot || !camera) return false;
    this.camera = camera;
    this.steer(camera);
    return true;
  }

  change(how, ...amounts) {
    return this.camera ? this.turnTo(how(this.camera, ...amounts)) : false;
  }

  down(event) {
    this.canvas.focus();
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const all = [...this.pointers.values()];
    this.pointers.set(event.pointerId, now);
    const height = this.canvas.clientHeight;
    const right = (now[0] - before[0]) / height, down = (now[1] - before[1]) / height;
    if (all.length === 2) return this.twoFingers(all, [...this.pointers.values()], height);
    if (event.altKey) return this.change(rolled, Math.PI * right);
    if (event.shiftKey || event.buttons & 2) return this.change(panned, right, -down);
    this.change(orbited, Math.PI * right, Math.PI * down);
  }

  // Both fingers before and now: they shift, spread and twist.
  twoFingers(before, now, height) {
    const middle = ([a, b]) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    const arm = ([a, b]) => [b[0] - a[0], b[1] - a[1]];
    const m0 = middle(before), m1 = middle(now), a0 = arm(before), a1 = arm(now);
    this.change((camera) => {
      const shifted = panned(camera, (m1[0] - m0[0]) / height, (m0[1] - m1[1]) / height);
      const nearer = dollied(shifted, Math.hypot(...a0) / Math.max(1, Math.hypot(...a1)));
      return rolled(nearer, Math.atan2(a1[1], a1[0]) - Math.atan2(a0[1], a0[0]));
    });
  }

  wheel(event) {
    event.preventDefault();
    const factor = Math.exp(Math.sign(event.deltaY) * Math.min(0.3, Math.abs(event.deltaY) / 800));
    this.change(event.altKey ? zoomed : dollied, factor);
  }

  // Whether the key moved the camera.
  key(event) {
    const step = 0.06;
    const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
    const arrow = arrows[event.key];
    if (arrow) {
      if (event.shiftKey) return this.change(panned, -step * arrow[0], -step * arrow[1]);
      return this.change(orbited, -step * arrow[0], step * arrow[1]);
    }
    switch (event.key) {
      case "+": case "=": return this.change(dollied, 1 / 1.08);
      case "-": return this.change(dollied, 1.08);
      case "[": return this.change(zoomed, 1 / 1.06);
      case "]": return this.change(zoomed, 1.06);
      case ",": return this.change(rolled, -step);
      case ".": return this.change(rolled, step);
      case "h": return this.turnTo(this.home);
      case "Home": return this.frameAll();
      default: return false;
    }
  }
}
