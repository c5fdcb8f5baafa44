"use strict";
// The robot from above. Everything is drawn in pixels of the view box; project() brings metres there.

const sceneWidth = 720;
const sceneHeight = 650;
const arrowPixels = 150; // length of the largest force
const closeUpWidth = 0.6; // metres across the close-up

const scene = {
  svg: byId("scene"),
  closeUp: false,

  available() {
    return report.robot !== null && has("pose_x", "pose_y", "pose_phi") &&
      report.robot.legs.every((_, i) => has(`qa_${i + 1}`));
  },

  start() {
    byId("robot").hidden = !this.available() && lastSample === 0;
    this.svg.closest(".stage").hidden = !this.available();
    if (!this.available()) return;
    set(this.svg, { viewBox: `0 0 ${sceneWidth} ${sceneHeight}` });
    this.newtonsPerPixel = largestForce() / arrowPixels;
    this.build();
    for (const [id, closeUp] of [["view-whole", false], ["view-close", true]]) {
      byId(id).addEventListener("click", () => this.view(closeUp));
    }
    this.view(false);
    clock.follow((sample) => this.show(sample));
  },

  view(closeUp) {
    this.closeUp = closeUp;
    byId("view-whole").setAttribute("aria-pressed", String(!closeUp));
    byId("view-close").setAttribute("aria-pressed", String(closeUp));
    const box = closeUp ? closeUpBox() : wholeBox();
    this.scale = Math.min(sceneWidth / (box.right - box.left), sceneHeight / (box.top - box.bottom));
    this.centre = [(box.left + box.right) / 2, (box.bottom + box.top) / 2];
    this.drawFixed();
    if (clock.sample >= 0) this.show(clock.sample);
  },

  project([x, y]) {
    return [sceneWidth / 2 + (x - this.centre[0]) * this.scale, sceneHeight / 2 - (y - this.centre[1]) * this.scale];
  },

  /** Layers from the floor up. */
  build() {
    for (const name of ["grid", "links", "obstacles", "platform", "path", "marks", "forces", "scales"]) {
      this[name] = shape(this.svg, "g", { class: `layer-${name}` });
    }
    this.pathAhead = shape(this.path, "path", { class: "path-ahead" });
    this.pathDone = shape(this.path, "path", { class: "path-done" });
    this.legs = report.robot.legs.map((_, i) => this.buildLeg(i));
    this.buildPlatform();
    this.action = shape(this.forces, "line", { class: "action" });
    this.trueForces = [1, 2].map(() => shape(this.forces, "path", { class: "force-true" }));
    this.estimate = shape(this.forces, "path", { class: "force-estimate" });
    this.points = [1, 2].map(() => shape(this.forces, "circle", { r: 4.5, class: "contact-point" }));
    this.pulse = shape(this.marks, "circle", { class: "pulse" });
  },

  buildLeg(i) {
    const group = shape(this.links, "g", { class: `leg leg-${i + 1}` });
    const outer = [1, 2].map(() => shape(group, "line", { class: "link-edge" }));
    const inner = [1, 2].map(() => shape(group, "line", { class: "link" }));
    const joints = ["base", "elbow"].map((name) => shape(group, "circle", { class: `joint ${name}` }));
    const pin = shape(group, "circle", { class: "pin", r: 2.5 });
    const label = shape(group, "text", { class: "leg-name" });
    label.textContent = String(i + 1);
    return { outer, inner, joints, pin, label };
  },

  buildPlatform() {
    this.hull = shape(this.platform, "circle", { class: "hull" });
    this.triangle = shape(this.platform, "path", { class: "triangle" });
    this.heading = shape(this.platform, "line", { class: "heading" });
    this.couplings = report.robot.legs.map((_, i) => shape(this.platform, "circle", { class: `coupling leg-${i + 1}` }));
    this.origin = shape(this.platform, "circle", { class: "origin", r: 2.5 });
  },

  show(sample) {
    const pose = poseAt(sample);
    if (!pose) return;
    this.showLegs(pose, sample);
    this.showPlatform(pose);
    this.showPath(sample);
    this.showForces(pose, sample);
    this.showMarks(pose, sample);
    this.svg.setAttribute("aria-label", describeScene(sample));
    byId("state").textContent = report.lanes.filter((lane) => lane.name === "mode")
      .map((lane) => lane.states[stateOf(lane, sample)] ?? none).join();
  },

  showLegs(pose, sample) {
    const width = 2 * report.robot.link_radius * this.scale;
    report.robot.legs.forEach((leg, i) => {
      const points = legPoints(leg, pose, valueOf(`qa_${i + 1}`, sample)).map((point) => this.project(point));
      const drawn = this.legs[i];
      [0, 1].forEach((link) => {
        const ends = lineEnds(points[link], points[link + 1]);
        set(drawn.outer[link], { ...ends, "stroke-width": width });
        set(drawn.inner[link], { ...ends, "stroke-width": Math.max(1, width - 2.5) });
      });
      set(drawn.joints[0], { ...centreOf(points[0]), r: 0.75 * width });
      set(drawn.joints[1], { ...centreOf(points[1]), r: 0.3 * width });
      set(drawn.pin, centreOf(points[0]));
      set(drawn.label, { x: points[0][0], y: points[0][1] - 0.75 * width - 7 });
      set(this.couplings[i], { ...centreOf(points[2]), r: 0.3 * width });
    });
  },

  showPlatform(pose) {
    const centre = this.project(pose);
    const corners = report.robot.legs.map((leg) => this.project(inBase(pose, leg.coupling)));
    set(this.hull, { ...centreOf(centre), r: report.robot.platform_radius * this.scale });
    set(this.triangle, { d: polyline(corners) + "Z" });
    set(this.heading, lineEnds(centre, this.project(inBase(pose, [0.5 * report.robot.platform_radius, 0]))));
    set(this.origin, centreOf(centre));
  },

  showPath(sample) {
    const past = this.pathPoints.filter((point) => point.sample <= sample).map((point) => point.pixel);
    past.push(this.project(poseAt(sample)));
    set(this.pathDone, { d: polyline(past) });
  },

  showForces(pose, sample) {
    [1, 2].forEach((i) => {
      const point = vectorAt(`contact_${i}_`, sample);
      const force = vectorAt(`contact_${i}_force_`, sample);
      const there = point && force && Math.hypot(...force) > 0;
      set(this.trueForces[i - 1], { d: there ? this.arrow(point, force, 9, 26) : "" });
      set(this.points[i - 1], there ? { ...centreOf(this.project(point)), visibility: "visible" } : { visibility: "hidden" });
    });
    const estimate = vectorAt("estimated_force_", sample);
    const shown = estimate && Math.hypot(...estimate) >= noticeableForce();
    const foot = vectorAt("isolated_", sample) ?? pose;
    set(this.estimate, { d: shown ? this.arrow(foot, estimate, 2.5, 11) : "" });
    set(this.action, shown ? this.lineOfAction(pose, estimate, valueOf("estimated_moment", sample)) : { visibility: "hidden" });
  },

  /** Outline of an arrow of a force that acts at a point. */
  arrow(point, force, shaft, head) {
    const [x, y] = this.project(point);
    const length = Math.hypot(...force) / this.newtonsPerPixel;
    const [ux, uy] = [force[0] / Math.hypot(...force), -force[1] / Math.hypot(...force)];
    const neck = Math.max(0, length - head);
    const corner = (along, across) => [x + along * ux - across * uy, y + along * uy + across * ux];
    const half = Math.min(shaft / 2, length / 4);
    const wing = Math.min(head / 2, length / 2.5);
    return polyline([corner(0, -half), corner(neck, -half), corner(neck, -wing), corner(length, 0),
      corner(neck, wing), corner(neck, half), corner(0, half)]) + "Z";
  },

  /** Line of action of the estimated wrench, [SafePR] (15), (16). */
  lineOfAction(pose, force, moment) {
    if (moment === null) return { visibility: "hidden" };
    const size = Math.hypot(...force);
    const foot = [pose[0] + (force[1] * moment) / size ** 2, pose[1] - (force[0] * moment) / size ** 2];
    const far = [-2, 2].map((along) => this.project([0, 1].map((k) => foot[k] + (along * force[k]) / size)));
    return { ...lineEnds(...far), visibility: "visible" };
  },

  /** Rings where contact and detection happened, and a wave that runs out from the platform as it notices. */
  showMarks(pose, sample) {
    const current = contactAt(timeOf(sample));
    for (const mark of this.events) {
      set(mark.group, { visibility: mark.contact === current && sample >= mark.sample ? "visible" : "hidden" });
    }
    const noticed = report.contacts.filter((contact) => contact.detected !== null && sampleAt(contact.detected) <= sample);
    const age = noticed.length ? timeOf(sample) - noticed.at(-1).detected : Infinity;
    const radius = (report.robot.platform_radius + 0.3 * age) * this.scale;
    set(this.pulse, { ...centreOf(this.project(pose)), r: Math.min(radius, 1e3), opacity: Math.max(0, 1 - age / 0.25) });
  },

  drawFixed() {
    this.drawGrid();
    this.drawObstacles();
    this.drawPath();
    this.drawEvents();
    this.drawScales();
  },

  drawGrid() {
    this.grid.replaceChildren();
    const step = 0.1 * this.scale;
    const [x0, y0] = this.project([0, 0]);
    for (let x = ((x0 % step) + step) % step; x < sceneWidth; x += step) {
      shape(this.grid, "line", { x1: x, x2: x, y1: 0, y2: sceneHeight });
    }
    for (let y = ((y0 % step) + step) % step; y < sceneHeight; y += step) {
      shape(this.grid, "line", { x1: 0, x2: sceneWidth, y1: y, y2: y });
    }
  },

  drawObstacles() {
    this.obstacles.replaceChildren();
    for (const { name, centre, radius } of report.obstacles) {
      const [cx, cy] = this.project(centre);
      const r = radius * this.scale;
      shape(this.obstacles, "circle", { cx, cy, r, class: "obstacle" });
      shape(this.obstacles, "circle", { cx, cy, r: 0.55 * r, class: "obstacle-ring" });
      shape(this.obstacles, "text", { x: cx, y: cy - r - 8, class: "obstacle-name" }).textContent = name;
    }
  },

  /** The platform's way, at most 800 points of it. */
  drawPath() {
    const stride = Math.ceil((lastSample + 1) / 800);
    this.pathPoints = [];
    for (let sample = 0; sample <= lastSample; sample += stride) {
      const pose = poseAt(sample);
      if (pose) this.pathPoints.push({ sample, pixel: this.project(pose) });
    }
    set(this.pathAhead, { d: polyline(this.pathPoints.map((point) => point.pixel)) });
  },

  drawEvents() {
    for (const mark of this.events ?? []) mark.group.remove();
    this.events = report.contacts.flatMap((contact) => [
      this.mark(contact, contact.start, "contact", "contact", -1),
      this.mark(contact, contact.detected, "detected", `detected ${sinceContact(contact.detected).replace("contact ", "")}`, 1),
    ]).filter((mark) => mark !== null);
  },

  /** A ring where the platform was, with its name to the left (-1) or right (1). */
  mark(contact, time, kind, text, side) {
    const pose = time === null ? null : poseAt(sampleAt(time));
    if (!pose) return null;
    const [x, y] = this.project(pose);
    const reach = side * (report.robot.platform_radius * this.scale + 22);
    const group = shape(this.marks, "g", { class: `mark-${kind}` });
    shape(group, "line", { x1: x + side * 5, y1: y, x2: x + reach, y2: y });
    shape(group, "circle", { cx: x, cy: y, r: 5 });
    const label = shape(group, "text", { x: x + reach + side * 6, y: y + 4, "text-anchor": side < 0 ? "end" : "start" });
    label.textContent = text;
    return { group, contact, sample: sampleAt(time) };
  },

  /** What an arrow and a length mean. */
  drawScales() {
    this.scales.replaceChildren();
    const force = niceBelow(0.5 * arrowPixels * this.newtonsPerPixel);
    const length = niceBelow(110 / this.scale);
    const rows = [[force / this.newtonsPerPixel, `${force} N`], [length * this.scale, `${chosen(1000 * length)} mm`]];
    rows.forEach(([pixels, text], row) => {
      const y = sceneHeight - 18 - 22 * row;
      const d = row === 0
        ? `M18 ${y}h${pixels - 8}m0-4.5l8 4.5l-8 4.5Z`
        : `M18 ${y - 4}v8m0-4h${pixels}m0-4v8`;
      shape(this.scales, "path", { d, class: row === 0 ? "scale-force" : "scale-length" });
      shape(this.scales, "text", { x: 18 + pixels + 8, y: y + 4 }).textContent = text;
    });
  },
};

/** (x, y, phi) of the platform; null where the record has none. */
function poseAt(sample) {
  const pose = ["pose_x", "pose_y", "pose_phi"].map((name) => valueOf(name, sample));
  return pose.includes(null) ? null : pose;
}

/** A planar vector from two columns; null where one has no value. */
function vectorAt(prefix, sample) {
  const vector = [valueOf(`${prefix}x`, sample), valueOf(`${prefix}y`, sample)];
  return vector.includes(null) ? null : vector;
}

/** A point of the platform frame in the base frame. */
function inBase([x, y, phi], [u, v]) {
  return [x + u * Math.cos(phi) - v * Math.sin(phi), y + u * Math.sin(phi) + v * Math.cos(phi)];
}

/** Base, passive and coupling joint of a leg. */
function legPoints(leg, pose, qa) {
  const theta = leg.angle + qa;
  const elbow = [leg.base[0] + leg.proximal * Math.cos(theta), leg.base[1] + leg.proximal * Math.sin(theta)];
  return [leg.base, elbow, inBase(pose, leg.coupling)];
}

/** Around the base joints and everywhere that the elbows go. */
function wholeBox() {
  const points = [];
  for (let sample = 0; sample <= lastSample; sample += Math.ceil((lastSample + 1) / 100)) {
    const pose = poseAt(sample);
    if (pose) report.robot.legs.forEach((leg, i) => points.push(...legPoints(leg, pose, valueOf(`qa_${i + 1}`, sample))));
  }
  points.push(...report.robot.legs.map((leg) => leg.base));
  const [xs, ys] = [0, 1].map((k) => points.map((point) => point[k]));
  const margin = 3.2 * report.robot.link_radius;
  return { left: Math.min(...xs) - margin, right: Math.max(...xs) + margin,
    bottom: Math.min(...ys) - margin, top: Math.max(...ys) + margin };
}

/** Around the worst contact and the platform, or around where the platform starts. */
function closeUpBox() {
  const contact = worstContact();
  const sample = contact ? sampleAt(contact.peak_time ?? contact.start) : 0;
  const pose = poseAt(sample) ?? [0, 0];
  const point = vectorAt("contact_1_", sample) ?? pose;
  const [x, y] = [0, 1].map((k) => (pose[k] + point[k]) / 2);
  const half = closeUpWidth / 2;
  return { left: x - half, right: x + half, bottom: y - half, top: y + half };
}

function largestForce() {
  const columns = [magnitude("contact_1_force_x", "contact_1_force_y"), magnitude("estimated_force_x", "estimated_force_y")];
  return columns.flat().reduce((largest, value) => Math.max(largest, value ?? 0), 20);
}

/** Below this an estimated force is noise and is not drawn: the smallest threshold of the force chart, or 5 N. */
function noticeableForce() {
  const thresholds = report.bounds.filter((bound) => bound.chart === "force" && bound.value > 0);
  return Math.min(...thresholds.map((bound) => bound.value), thresholds.length ? Infinity : 5);
}

/** The largest of 1, 2, 5 times a power of ten that is not above the value. */
function niceBelow(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].find((step) => step * power <= value) * power;
}

function describeScene(sample) {
  const force = valueOf("contact_force", sample);
  const contact = force > 0 ? `, pressed with ${fixed(force, 0)} newton` : "";
  return `The robot from above at ${fixed(timeOf(sample), 3)} seconds${contact}`;
}

function polyline(points) {
  return points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");
}

function lineEnds([x1, y1], [x2, y2]) {
  return { x1, y1, x2, y2 };
}

function centreOf([cx, cy]) {
  return { cx, cy };
}
