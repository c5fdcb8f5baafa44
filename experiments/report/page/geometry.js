"use strict";
// Where the robot's bodies are at a sample: vectors are [x, y, z] in the base frame, metres. A planar robot has z = 0.

const isSpatial = has("pose_z");

/** Position of the platform and the columns of its rotation matrix; null where the record has none. */
function poseAt(sample) {
  const position = vectorAt("pose_", sample);
  if (!position) return null;
  if (has("pose_qw")) {
    const q = ["w", "x", "y", "z"].map((part) => valueOf(`pose_q${part}`, sample));
    return q.includes(null) ? null : { position, axes: axesOf(q) };
  }
  const phi = has("pose_phi") ? valueOf("pose_phi", sample) : 0;
  if (phi === null) return null;
  return { position, axes: [[Math.cos(phi), Math.sin(phi), 0], [-Math.sin(phi), Math.cos(phi), 0], [0, 0, 1]] };
}

/** Columns of the rotation matrix of a unit quaternion. */
function axesOf([w, x, y, z]) {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ];
}

/** A vector from its columns; the third is 0 where there is no such column. Null where one has no value. */
function vectorAt(prefix, sample) {
  const vector = ["x", "y", "z"].map((axis) => (has(prefix + axis) || axis !== "z" ? valueOf(prefix + axis, sample) : 0));
  return vector.includes(null) ? null : vector;
}

/** Moment about the platform's origin; a planar one has only its z component. */
function momentAt(prefix, sample) {
  if (has(`${prefix}_x`)) return vectorAt(`${prefix}_`, sample);
  const moment = has(prefix) ? valueOf(prefix, sample) : 0;
  return moment === null ? null : [0, 0, moment];
}

/** A point of the platform frame in the base frame. */
function inBase({ position, axes }, point) {
  return position.map((value, k) => value + axes[0][k] * point[0] + axes[1][k] * point[1] + axes[2][k] * point[2]);
}

/** Base, passive and coupling joint of leg i. */
function legPoints(i, pose, sample) {
  const leg = report.robot.legs[i];
  const coupling = inBase(pose, leg.coupling);
  return [leg.base, vectorAt(`elbow_${i + 1}_`, sample) ?? coupling, coupling];
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/** Corners of the convex hull of points in a plane, in order. */
function convexHull(points) {
  if (points.length < 3) return points;
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turns = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const half = (list) => list.reduce((chain, point) => {
    while (chain.length >= 2 && turns(chain.at(-2), chain.at(-1), point) <= 0) chain.pop();
    return [...chain, point];
  }, []).slice(0, -1);
  return [...half(sorted), ...half(sorted.reverse())];
}

/** The largest of 1, 2, 5 times a power of ten that is not above the value. */
function niceBelow(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].find((step) => step * power <= value) * power;
}
