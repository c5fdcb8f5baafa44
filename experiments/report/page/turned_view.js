"use strict";
// A robot in space from any side: drag turns it, the wheel or two fingers zoom, Shift and drag move it.

const radiansPerPixel = 0.008;
const steepest = 0.4999 * Math.PI; // elevation, so that up stays up
const keyTurn = 0.1; // radians a key press
const keyZoom = 1.2;

class TurnedView extends View {
  /** `changed` is called after every turn, zoom and move. */
  constructor(svg, box, changed) {
    super(svg, "", [0, 1, 0], [0, 0, 1], box);
    Object.assign(this, { changed, azimuth: -1.05, elevation: 0.42, focus: [0, 0, 0], fingers: new Map() });
    this.svg.prepend(shape(this.svg, "rect", { width: box.width, height: box.height, class: "backdrop" }));
    this.bodies = shape(this.svg, "g", { class: "layer-bodies" });
    this.grid.after(this.bodies);
    set(this.svg, { tabindex: 0, role: "application", "aria-label": "The robot in space: arrow keys turn it, + and - zoom" });
    this.svg.addEventListener("pointerdown", (event) => this.press(event));
    this.svg.addEventListener("pointermove", (event) => this.drag(event));
    for (const end of ["pointerup", "pointercancel"]) {
      this.svg.addEventListener(end, (event) => this.fingers.delete(event.pointerId));
    }
    this.svg.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    this.svg.addEventListener("keydown", (event) => this.key(event));
    this.turn(0, 0);
  }

  /** The middle of the points, and a square around it that they stay in however they are turned. */
  boxAround(points, margin) {
    const bounds = [0, 1, 2].map((k) => [Math.min(...points.map((p) => p[k])), Math.max(...points.map((p) => p[k]))]);
    this.focus = bounds.map(([least, most]) => (least + most) / 2);
    this.floor = bounds[2][0];
    const reach = Math.max(...points.map((p) => Math.hypot(...p.map((value, k) => value - this.focus[k])))) * 0.9 + margin;
    const [x, y] = this.flat(this.focus);
    return { left: x - reach, right: x + reach, bottom: y - reach, top: y + reach };
  }

  frame(box, scale, newtonsPerPixel) {
    this.arrowNewtons = newtonsPerPixel * scale; // arrows grow as the robot does
    this.pan = [0, 0];
    super.frame(box, scale, newtonsPerPixel);
  }

  /** Turns by so many radians about the vertical, and up. */
  turn(about, up) {
    this.azimuth += about;
    this.elevation = Math.max(-steepest, Math.min(steepest, this.elevation + up));
    const [ca, sa, ce, se] = [Math.cos(this.azimuth), Math.sin(this.azimuth), Math.cos(this.elevation), Math.sin(this.elevation)];
    this.right = [-sa, ca, 0];
    this.up = [-se * ca, -se * sa, ce];
    this.towards = [ce * ca, ce * sa, se];
    this.redraw();
  }

  zoom(factor) {
    this.scale = Math.max(20, Math.min(20000, this.scale * factor));
    this.pan = this.pan.map((value) => value * factor);
    this.redraw();
  }

  move(right, down) {
    this.pan = [this.pan[0] + right, this.pan[1] + down];
    this.redraw();
  }

  redraw() {
    if (!this.scale) return;
    const [x, y] = this.flat(this.focus);
    this.centre = [x - this.pan[0] / this.scale, y + this.pan[1] / this.scale];
    this.newtonsPerPixel = this.arrowNewtons / this.scale;
    this.drawAround();
    if (clock.sample >= 0) this.show(clock.sample);
    this.changed();
  }

  show(sample) {
    super.show(sample);
    this.sortBodies(sample);
  }

  /** What is nearer to the reader is drawn over what is farther away. */
  sortBodies(sample) {
    const pose = poseAt(sample);
    if (!pose) return;
    const depth = (points) => points.reduce((sum, point) => sum + dot(point, this.towards), 0) / points.length;
    const bodies = this.legs.map((leg, i) => [leg.group, depth(legPoints(i, pose, sample))]);
    bodies.push([this.platform, depth([pose.position])]);
    this.obstacleGroups.forEach((group, i) => bodies.push([group, depth(report.obstacles[i].points)]));
    const order = bodies.sort((a, b) => a[1] - b[1]).map(([group]) => group);
    if (order.some((group, i) => this.bodies.children[i] !== group)) this.bodies.replaceChildren(...order);
  }

  /** The floor below the robot, a line each 100 mm. */
  drawGrid() {
    this.grid.replaceChildren();
    const half = Math.ceil(0.6 * this.width / this.scale / 0.1 + 1) * 0.1;
    const [cx, cy] = [0, 1].map((k) => Math.round(this.focus[k] / 0.1) * 0.1);
    const reach = Math.min(half, 1.5);
    for (let along = -reach; along <= reach + 1e-9; along += 0.1) {
      for (const ends of [[[cx + along, cy - reach], [cx + along, cy + reach]], [[cx - reach, cy + along], [cx + reach, cy + along]]]) {
        shape(this.grid, "line", lineEnds(...ends.map(([x, y]) => this.project([x, y, this.floor]))));
      }
    }
  }

  press(event) {
    this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
    this.svg.setPointerCapture(event.pointerId);
    this.svg.focus({ preventScroll: true });
  }

  drag(event) {
    const before = this.fingers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const [dx, dy] = now.map((value, k) => value - before[k]);
    const other = [...this.fingers].find(([id]) => id !== event.pointerId)?.[1];
    this.fingers.set(event.pointerId, now);
    const pixel = this.svg.getScreenCTM().a;
    if (other) {
      const apart = (point) => Math.max(1, Math.hypot(...point.map((value, k) => value - other[k])));
      this.zoom(apart(now) / apart(before));
    } else if (event.shiftKey || event.buttons > 1) {
      this.move(dx / pixel, dy / pixel);
    } else {
      this.turn(-dx * radiansPerPixel, dy * radiansPerPixel);
    }
  }

  wheel(event) {
    event.preventDefault();
    this.zoom(Math.exp(-0.0015 * event.deltaY));
  }

  /** Keys that turn and zoom, and do not reach the clock. */
  key(event) {
    const acts = {
      ArrowLeft: () => this.turn(-keyTurn, 0), ArrowRight: () => this.turn(keyTurn, 0),
      ArrowUp: () => this.turn(0, keyTurn), ArrowDown: () => this.turn(0, -keyTurn),
      "+": () => this.zoom(keyZoom), "-": () => this.zoom(1 / keyZoom),
    };
    if (!(event.key in acts) || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    acts[event.key]();
  }
}
