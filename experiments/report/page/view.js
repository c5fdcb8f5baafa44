"use strict";
// The robot seen from one side, without perspective. Everything is drawn in pixels of the view's box; project() brings metres there.

class View {
  /** `right` and `up` are the unit vectors that point there; the box is in pixels. */
  constructor(svg, name, right, up, box) {
    Object.assign(this, { name, right, up, ...box });
    this.svg = shape(svg, "svg", { ...box, viewBox: `0 0 ${box.width} ${box.height}`, class: "view" });
    this.build();
    shape(this.svg, "text", { x: 18, y: 24, class: "view-name" }).textContent = name;
    this.head = name ? 34 : 0;
  }

  /** Pixels a metre at which the rectangle {left, right, bottom, top} [m] of the view's plane fits. */
  scaleOf(box) {
    return Math.min(this.width / (box.right - box.left), (this.height - this.head) / (box.top - box.bottom));
  }

  /** Shows what is around the middle of that rectangle. */
  frame(box, scale, newtonsPerPixel) {
    this.newtonsPerPixel = newtonsPerPixel;
    this.scale = scale;
    this.centre = [(box.left + box.right) / 2, (box.bottom + box.top) / 2];
    this.drawAround();
  }

  /** Everything that does not move with the robot. */
  drawAround() {
    this.drawGrid();
    this.drawObstacles();
    this.drawPath();
    this.drawEvents();
  }

  /** The rectangle around points [m] in the view's plane, with a margin. */
  boxAround(points, margin) {
    const [xs, ys] = [0, 1].map((k) => points.map((point) => this.flat(point)[k]));
    return { left: Math.min(...xs) - margin, right: Math.max(...xs) + margin,
      bottom: Math.min(...ys) - margin, top: Math.max(...ys) + margin };
  }

  flat(vector) {
    return [dot(vector, this.right), dot(vector, this.up)];
  }

  project(point) {
    const [right, up] = this.flat(point);
    return [this.width / 2 + (right - this.centre[0]) * this.scale,
      (this.height + this.head) / 2 - (up - this.centre[1]) * this.scale];
  }

  /** Layers from the floor up. */
  build() {
    for (const name of ["grid", "links", "obstacles", "platform", "path", "marks", "forces"]) {
      this[name] = shape(this.svg, "g", { class: `layer-${name}` });
    }
    this.pathAhead = shape(this.path, "path", { class: "path-ahead" });
    this.pathDone = shape(this.path, "path", { class: "path-done" });
    this.legs = report.robot.legs.map((_, i) => this.buildLeg(i));
    this.buildPlatform();
    this.action = shape(this.forces, "line", { class: "action" });
    this.trueForces = [1, 2].map(() => shape(this.forces, "path", { class: "force-true" }));
    this.estimate = shape(this.forces, "path", { class: "force-estimate" });
    this.particles = Array.from({ length: columnCount("particle_", "_x") }, () =>
      shape(this.forces, "circle", { r: 3, class: "particle" }));
    this.isolated = shape(this.forces, "circle", { r: 6, class: "isolated-point" });
    this.points = [1, 2].map(() => shape(this.forces, "circle", { r: 4.5, class: "contact-point" }));
    this.pulse = shape(this.marks, "circle", { class: "pulse" });
  }

  buildLeg(i) {
    const group = shape(this.links, "g", { class: `leg leg-${i + 1}` });
    const outer = [1, 2].map(() => shape(group, "line", { class: "link-edge" }));
    const inner = [1, 2].map(() => shape(group, "line", { class: "link" }));
    const joints = ["base", "elbow"].map((name) => shape(group, "circle", { class: `joint ${name}` }));
    const pin = shape(group, "circle", { class: "pin", r: 2.5 });
    const label = shape(group, "text", { class: "leg-name" });
    label.textContent = String(i + 1);
    return { group, outer, inner, joints, pin, label };
  }

  buildPlatform() {
    const hull = shape(this.platform, "g", { class: "hull" });
    [this.hullEdge, this.hull] = ["hull-edge", "hull-face"].map((name) => shape(hull, "path", { class: name }));
    this.polygon = shape(this.platform, "path", { class: "triangle" });
    this.heading = shape(this.platform, "line", { class: "heading" });
    this.couplings = report.robot.legs.map((_, i) => shape(this.platform, "circle", { class: `coupling leg-${i + 1}` }));
    this.origin = shape(this.platform, "circle", { class: "origin", r: 2.5 });
  }

  show(sample) {
    const pose = poseAt(sample);
    if (!pose) return;
    this.showLegs(pose, sample);
    this.showObstacles(sample);
    this.showPlatform(pose);
    this.showPath(pose, sample);
    this.showForces(pose, sample);
    this.showMarks(pose, sample);
  }

  showLegs(pose, sample) {
    const width = Math.max(3, 2 * report.robot.link_radius * this.scale);
    report.robot.legs.forEach((_, i) => {
      const points = legPoints(i, pose, sample).map((point) => this.project(point));
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
  }

  /** The outline is that of the platform's hull, grown by its radius. */
  showPlatform(pose) {
    const { platform, platform_radius: radius, legs } = report.robot;
    const reach = Math.max(radius, ...platform.map((point) => Math.hypot(...point)));
    const outline = convexHull(platform.map((point) => this.project(inBase(pose, point))));
    const width = 2 * radius * this.scale;
    set(this.hullEdge, { d: polyline(outline) + "Z", "stroke-width": width + 3 });
    set(this.hull, { d: polyline(outline) + "Z", "stroke-width": width });
    const corners = legs.map((leg) => this.project(inBase(pose, leg.coupling)));
    set(this.polygon, { d: polyline(isSpatial ? convexHull(corners) : corners) + "Z" });
    const centre = this.project(pose.position);
    set(this.heading, lineEnds(centre, this.project(inBase(pose, [0.5 * reach, 0, 0]))));
    set(this.origin, centreOf(centre));
  }

  showPath(pose, sample) {
    const past = this.pathPoints.filter((point) => point.sample <= sample).map((point) => point.pixel);
    past.push(this.project(pose.position));
    set(this.pathDone, { d: polyline(past) });
  }

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
    this.showPoint(this.isolated, vectorAt("isolated_", sample));
    this.particles.forEach((particle, i) => this.showPoint(particle, vectorAt(`particle_${i + 1}_`, sample)));
    const foot = (has("isolated_x") && vectorAt("isolated_", sample)) || pose.position;
    set(this.estimate, { d: shown ? this.arrow(foot, estimate, 2.5, 11) : "" });
    set(this.action, shown ? this.lineOfAction(pose, estimate, momentAt("estimated_moment", sample)) : { visibility: "hidden" });
  }

  /** Hidden where there is none. */
  showPoint(circle, point) {
    set(circle, point ? { ...centreOf(this.project(point)), visibility: "visible" } : { visibility: "hidden" });
  }

  /** Outline of an arrow of a force that acts at a point; nothing where it points at the reader. */
  arrow(point, force, shaft, head) {
    const [x, y] = this.project(point);
    const seen = this.flat(force);
    const size = Math.hypot(...seen);
    if (!(size > 1e-9)) return "";
    const length = size / this.newtonsPerPixel;
    const [ux, uy] = [seen[0] / size, -seen[1] / size];
    const neck = Math.max(0, length - head);
    const corner = (along, across) => [x + along * ux - across * uy, y + along * uy + across * ux];
    const half = Math.min(shaft / 2, length / 4);
    const wing = Math.min(head / 2, length / 2.5);
    return polyline([corner(0, -half), corner(neck, -half), corner(neck, -wing), corner(length, 0),
      corner(neck, wing), corner(neck, half), corner(0, half)]) + "Z";
  }

  /** Line of action of the estimated wrench: its point nearest to the platform's origin is f x m / |f|^2. [SafePR] (15), (16) */
  lineOfAction(pose, force, moment) {
    if (moment === null) return { visibility: "hidden" };
    const size = Math.hypot(...force);
    const foot = cross(force, moment).map((value, k) => pose.position[k] + value / size ** 2);
    const far = [-2, 2].map((along) => this.project(foot.map((value, k) => value + (along * force[k]) / size)));
    return { ...lineEnds(...far), visibility: "visible" };
  }

  /** Rings where contact and detection happened, and a wave that runs out from the platform as it detects. */
  showMarks(pose, sample) {
    const current = contactAt(timeOf(sample));
    for (const mark of this.events) {
      set(mark.group, { visibility: mark.contact === current && sample >= mark.sample ? "visible" : "hidden" });
    }
    const seen = report.contacts.filter((contact) => contact.detected !== null && sampleAt(contact.detected) <= sample);
    const age = seen.length ? timeOf(sample) - seen.at(-1).detected : Infinity;
    const radius = (platformReach() + 0.3 * age) * this.scale;
    set(this.pulse, { ...centreOf(this.project(pose.position)), r: Math.min(radius, 1e3), opacity: Math.max(0, 1 - age / 0.25) });
  }

  drawGrid() {
    this.grid.replaceChildren();
    const step = 0.1 * this.scale;
    const [x0, y0] = this.project([0, 0, 0]);
    for (let x = ((x0 % step) + step) % step; x < this.width; x += step) {
      shape(this.grid, "line", { x1: x, x2: x, y1: 0, y2: this.height });
    }
    for (let y = ((y0 % step) + step) % step; y < this.height; y += step) {
      shape(this.grid, "line", { x1: 0, x2: this.width, y1: y, y2: y });
    }
  }

  drawObstacles() {
    for (const group of this.obstacleGroups ?? []) group.remove();
    this.obstacleGroups = report.obstacles.map(({ name, points, radius }) => {
      const group = shape(this.obstacles, "g", {});
      const outline = convexHull(points.map((point) => this.project(point)));
      const width = 2 * radius * this.scale;
      const d = polyline(outline) + "Z";
      shape(group, "path", { d, class: "obstacle-edge", "stroke-width": width + 3 });
      shape(group, "path", { d, class: "obstacle", "stroke-width": width });
      const [x, y] = [0, 1].map((k) => outline.reduce((sum, point) => sum + point[k], 0) / outline.length);
      const top = Math.min(...outline.map((point) => point[1])) - width / 2;
      shape(group, "text", { x, y: Math.min(y, top) - 8, class: "obstacle-name" }).textContent = name;
      return group;
    });
  }

  /** Each where it is at the sample; one without columns stays where it is drawn. */
  showObstacles(sample) {
    this.obstacleGroups.forEach((group, i) => {
      if (!has(`obstacle_${i + 1}_x`)) return;
      const [right, up] = this.flat(vectorAt(`obstacle_${i + 1}_`, sample) ?? [0, 0, 0]);
      set(group, { transform: `translate(${(right * this.scale).toFixed(1)} ${(-up * this.scale).toFixed(1)})` });
    });
  }

  /** The platform's way, at most 800 points of it. */
  drawPath() {
    const stride = Math.ceil((lastSample + 1) / 800);
    this.pathPoints = [];
    for (let sample = 0; sample <= lastSample; sample += stride) {
      const pose = poseAt(sample);
      if (pose) this.pathPoints.push({ sample, pixel: this.project(pose.position) });
    }
    set(this.pathAhead, { d: polyline(this.pathPoints.map((point) => point.pixel)) });
  }

  drawEvents() {
    for (const mark of this.events ?? []) mark.group.remove();
    this.events = report.contacts.flatMap((contact) => [
      this.mark(contact, contact.start, "contact", "contact", -1),
      this.mark(contact, contact.detected, "detected", `detected ${sinceContact(contact.detected).replace("contact ", "")}`, 1),
    ]).filter((mark) => mark !== null);
  }

  /** A ring where the platform was, with its name to the left (-1) or right (1); one that does not fit stands below the line. */
  mark(contact, time, kind, text, side) {
    const pose = time === null ? null : poseAt(sampleAt(time));
    if (!pose) return null;
    const [x, y] = this.project(pose.position);
    const reach = side * (Math.min(platformReach() * this.scale, this.width / 4) + 22);
    const group = shape(this.marks, "g", { class: `mark-${kind}` });
    shape(group, "line", { x1: x + side * 5, y1: y, x2: x + reach, y2: y });
    shape(group, "circle", { cx: x, cy: y, r: 5 });
    const label = shape(group, "text", { x: x + reach + side * 6, y: y + 4, "text-anchor": side < 0 ? "end" : "start" });
    label.textContent = text;
    const room = side < 0 ? x + reach - 6 : this.width - x - reach - 6;
    if (label.getComputedTextLength() > room) set(label, { x: side < 0 ? 6 : this.width - 6, y: y + 18, "text-anchor": side < 0 ? "start" : "end" });
    return { group, contact, sample: sampleAt(time) };
  }
}

/** How far the platform extends from its origin [m]. */
function platformReach() {
  const { platform, platform_radius: radius } = report.robot;
  return radius + Math.max(...platform.map((point) => Math.hypot(...point)));
}

/** Below this an estimated force is noise and is not drawn: the smallest threshold of the force chart, or 5 N. */
function noticeableForce() {
  const thresholds = report.bounds.filter((bound) => bound.chart === "force" && bound.value > 0);
  return Math.min(...thresholds.map((bound) => bound.value), thresholds.length ? Infinity : 5);
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
