"use strict";
// The robot at the chosen time: a planar one from above, a spatial one from above, from the front and from the side.

const sceneWidth = 720;
const sceneHeight = 650;
const arrowPixels = 150; // length of the largest force
const closeUpWidth = 0.6; // metres across the close-up

const scene = {
  svg: byId("scene"),

  available() {
    return report.robot !== null && has("pose_x", "pose_y");
  },

  start() {
    byId("robot").hidden = !this.available() && lastSample === 0;
    this.svg.closest(".stage").hidden = !this.available();
    if (!this.available()) return;
    byId("key-true").hidden = !has("contact_1_force_x");
    set(this.svg, { viewBox: `0 0 ${sceneWidth} ${sceneHeight}` });
    byId("seen-from").textContent = isSpatial ? "Above, front, side" : "From above";
    this.views = isSpatial ? spatialViews(this.svg) : [new View(this.svg, "", 0, 1, panel(0, 0, 1, 1))];
    this.scales = shape(this.svg, "g", { class: "layer-scales" });
    for (const [id, closeUp] of [["view-whole", false], ["view-close", true]]) {
      byId(id).addEventListener("click", () => this.view(closeUp));
    }
    this.view(false);
    clock.follow((sample) => this.show(sample));
  },

  view(closeUp) {
    byId("view-whole").setAttribute("aria-pressed", String(!closeUp));
    byId("view-close").setAttribute("aria-pressed", String(closeUp));
    const newtonsPerPixel = (largestForce() / arrowPixels) * (isSpatial ? 2 : 1);
    const boxes = this.views.map((view) => (closeUp ? closeUpBox(view) : wholeBox(view)));
    const scale = Math.min(...this.views.map((view, i) => view.scaleOf(boxes[i])));
    this.views.forEach((view, i) => view.frame(boxes[i], scale, newtonsPerPixel));
    drawScales(this.scales, isSpatial ? sceneWidth / 2 : 0, isSpatial ? sceneHeight / 2 : sceneHeight, scale, newtonsPerPixel);
    if (clock.sample >= 0) this.show(clock.sample);
  },

  show(sample) {
    for (const view of this.views) view.show(sample);
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
function spatialViews(svg) {
  return [
    new View(svg, "above (x, y)", 0, 1, panel(0, 0, 0.5, 0.5)),
    new View(svg, "front (x, z)", 0, 2, panel(0, 0.5, 0.5, 0.5)),
    new View(svg, "side (y, z)", 1, 2, panel(0.5, 0.5, 0.5, 0.5)),
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

/** Around the base joints and everywhere that the legs and the platform go. */
function wholeBox(view) {
  const points = report.robot.legs.map((leg) => leg.base);
  for (let sample = 0; sample <= lastSample; sample += Math.ceil((lastSample + 1) / 100)) {
    const pose = poseAt(sample);
    if (!pose) continue;
    report.robot.legs.forEach((_, i) => points.push(...legPoints(i, pose, sample)));
    points.push(...report.robot.platform.map((point) => inBase(pose, point)));
  }
  const [xs, ys] = [0, 1].map((k) => points.map((point) => view.flat(point)[k]));
  const margin = 3.2 * report.robot.link_radius;
  return { left: Math.min(...xs) - margin, right: Math.max(...xs) + margin,
    bottom: Math.min(...ys) - margin, top: Math.max(...ys) + margin };
}

/** Around the worst contact and the platform, or around where the platform starts. */
function closeUpBox(view) {
  const contact = worstContact();
  const sample = contact ? sampleAt(contact.peak_time ?? contact.start) : 0;
  const position = poseAt(sample)?.position ?? [0, 0, 0];
  const point = vectorAt("contact_1_", sample) ?? position;
  const [x, y] = [0, 1].map((k) => (view.flat(position)[k] + view.flat(point)[k]) / 2);
  const half = closeUpWidth / 2;
  return { left: x - half, right: x + half, bottom: y - half, top: y + half };
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
