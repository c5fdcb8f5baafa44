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
    set(this.svg, { viewBox: `0 0 ${sceneWidth} ${sceneHeight}` });
    byId("seen-from").textContent = isSpatial ? "From above, from the front, from the side" : "From above";
    this.views = isSpatial ? spatialViews(this.svg) : [new View(this.svg, "", 0, 1, panel(0, 0, 1, 1))];
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
    for (const view of this.views) view.frame(closeUp ? closeUpBox(view) : wholeBox(view), newtonsPerPixel);
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
    new View(svg, "from above: x right, y up", 0, 1, panel(0, 0, 0.5, 0.5)),
    new View(svg, "from the front: x right, z up", 0, 2, panel(0, 0.5, 0.5, 0.5)),
    new View(svg, "from the side: y right, z up", 1, 2, panel(0.5, 0.5, 0.5, 0.5)),
  ];
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
