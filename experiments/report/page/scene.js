"use strict";
// The robot at the chosen time: a planar one from above, a spatial one from any side, or from above, front and side.

const sceneWidth = 720;
const sceneHeight = 650;
const arrowPixels = 150; // length of the largest force
const closeUpWidth = 0.6; // metres across the close-up
const fromAbove = [[1, 0, 0], [0, 1, 0]]; // what points right, and up

const scene = {
  svg: byId("scene"),
  isCloseUp: false,

  available() {
    return report.robot !== null && has("pose_x", "pose_y");
  },

  start() {
    byId("robot").hidden = !this.available() && lastSample === 0;
    this.svg.closest(".stage").hidden = !this.available();
    if (!this.available()) return;
    byId("key-true").hidden = !has("contact_1_force_x");
    set(this.svg, { viewBox: `0 0 ${sceneWidth} ${sceneHeight}` });
    this.sides = shape(this.svg, "g", { class: "sides" });
    this.views = isSpatial ? threeSides(this.sides) : [new View(this.sides, "", ...fromAbove, panel(0, 0, 1, 1))];
    this.scales = shape(this.sides, "g", { class: "layer-scales" });
    if (isSpatial) this.addTurned();
    for (const [id, closeUp] of [["view-whole", false], ["view-close", true]]) {
      byId(id).addEventListener("click", () => this.view(closeUp));
    }
    this.choose(isSpatial);
    clock.follow((sample) => this.show(sample));
  },

  /** The view that can be turned; paper shows the three sides instead. */
  addTurned() {
    const group = shape(this.svg, "g", { class: "turned" });
    const scales = shape(group, "g", { class: "layer-scales" });
    this.turned = new TurnedView(group, panel(0, 0, 1, 1), () =>
      drawScales(scales, 0, sceneHeight, this.turned.scale, this.turned.newtonsPerPixel));
    group.append(scales);
    byId("sides").hidden = false;
    byId("view-turned").addEventListener("click", () => this.choose(true));
    byId("view-sides").addEventListener("click", () => this.choose(false));
    window.addEventListener("beforeprint", () => {
      this.wasTurned = this.isTurned;
      this.choose(false);
    });
    window.addEventListener("afterprint", () => this.choose(this.wasTurned));
  },

  choose(turned) {
    this.isTurned = turned;
    this.svg.classList.toggle("shows-turned", turned);
    byId("seen-from").textContent = !isSpatial ? "From above" : turned ? "Drag to turn" : "Above, front, side";
    byId("view-turned").setAttribute("aria-pressed", String(turned));
    byId("view-sides").setAttribute("aria-pressed", String(!turned));
    this.view(this.isCloseUp);
  },

  view(closeUp) {
    this.isCloseUp = closeUp;
    byId("view-whole").setAttribute("aria-pressed", String(!closeUp));
    byId("view-close").setAttribute("aria-pressed", String(closeUp));
    const { points, margin } = closeUp ? closeUpTarget() : wholeTarget();
    const newtonsPerPixel = largestForce() / arrowPixels;
    const boxes = this.views.map((view) => view.boxAround(points, margin));
    const scale = Math.min(...this.views.map((view, i) => view.scaleOf(boxes[i])));
    const shrunk = newtonsPerPixel * (isSpatial ? 2 : 1);
    this.views.forEach((view, i) => view.frame(boxes[i], scale, shrunk));
    drawScales(this.scales, isSpatial ? sceneWidth / 2 : 0, isSpatial ? sceneHeight / 2 : sceneHeight, scale, shrunk);
    if (this.turned) {
      const box = this.turned.boxAround(points, margin);
      this.turned.frame(box, this.turned.scaleOf(box), newtonsPerPixel);
      this.turned.changed();
    }
    if (clock.sample >= 0) this.show(clock.sample);
  },

  show(sample) {
    for (const view of this.isTurned ? [this.turned] : this.views) view.show(sample);
    this.svg.setAttribute("aria-label", describeScene(sample));
    byId("state").textContent = report.lanes.filter((lane) => lane.name === "mode")
      .map((lane) => lane.states[stateOf(lane, sample)] ?? none).join();
  },
};

/** A part of the scene, in shares of its width and height. */
function panel(x, y, width, height) {
  return { x: x * sceneWidth, y: y * sceneHeight, width: width * sceneWidth, height: height * sceneHeight };
}

/** Each view lies beside the one that it shares an axis with. */
function threeSides(svg) {
  return [
    new View(svg, "above (x, y)", ...fromAbove, panel(0, 0, 0.5, 0.5)),
    new View(svg, "front (x, z)", [1, 0, 0], [0, 0, 1], panel(0, 0.5, 0.5, 0.5)),
    new View(svg, "side (y, z)", [0, 1, 0], [0, 0, 1], panel(0.5, 0.5, 0.5, 0.5)),
  ];
}

/** What an arrow and a length mean, above the point (left, bottom). */
function drawScales(group, left, bottom, scale, newtonsPerPixel) {
  group.replaceChildren();
  const force = niceBelow(0.5 * arrowPixels * newtonsPerPixel);
  const length = niceBelow(110 / scale);
  const rows = [[force / newtonsPerPixel, `${force} N`], [length * scale, `${chosen(1000 * length)} mm`]];
  rows.forEach(([pixels, text], row) => {
    const [x, y] = [left + 18, bottom - 18 - 22 * row];
    const d = row === 0
      ? `M${x} ${y}h${pixels - 8}m0-4.5l8 4.5l-8 4.5Z`
      : `M${x} ${y - 4}v8m0-4h${pixels}m0-4v8`;
    shape(group, "path", { d, class: row === 0 ? "scale-force" : "scale-length" });
    shape(group, "text", { x: x + pixels + 8, y: y + 4 }).textContent = text;
  });
}

/** The base joints and everywhere that the legs and the platform go. */
function wholeTarget() {
  const points = report.robot.legs.map((leg) => leg.base);
  for (let sample = 0; sample <= lastSample; sample += Math.ceil((lastSample + 1) / 100)) {
    const pose = poseAt(sample);
    if (!pose) continue;
    report.robot.legs.forEach((_, i) => points.push(...legPoints(i, pose, sample)));
    points.push(...report.robot.platform.map((point) => inBase(pose, point)));
  }
  return { points, margin: 3.2 * report.robot.link_radius };
}

/** Between the worst contact and the platform, or where the platform starts. */
function closeUpTarget() {
  const contact = worstContact();
  const sample = contact ? sampleAt(contact.peak_time ?? contact.start) : 0;
  const position = poseAt(sample)?.position ?? [0, 0, 0];
  const point = vectorAt("contact_1_", sample) ?? position;
  return { points: [position.map((value, k) => (value + point[k]) / 2)], margin: closeUpWidth / 2 };
}

function largestForce() {
  const columns = ["contact_1_force", "estimated_force"].map(magnitudeOf);
  return columns.flat().reduce((largest, value) => Math.max(largest, value ?? 0), 20);
}

function describeScene(sample) {
  const force = valueOf("contact_force", sample);
  const contact = force > 0 ? `, pressed with ${fixed(force, 0)} newton` : "";
  return `The robot at ${fixed(timeOf(sample), 3)} seconds${contact}`;
}
