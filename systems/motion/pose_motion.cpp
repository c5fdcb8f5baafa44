#include "systems/motion/pose_motion.h"

#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

PlatformVector stacked(const PlatformVector& translation, const PlatformVector& rotation) {
  PlatformVector both(translation.size() + rotation.size());
  both << translation, rotation;
  return both;
}

}  // namespace

PoseMotion PoseMotion::plan(const PlatformVector& start, const PlatformVector& start_velocity,
                            const PlatformVector& goal, int translations, const PoseLimits& limits) noexcept {
  PoseMotion resting;
  resting.goal_ = start;
  const Eigen::Index rotations = start.size() - translations;
  const bool same_size = start_velocity.size() == start.size() && goal.size() == start.size();
  if (!same_size || translations < 1 || rotations < 0) return resting;

  PoseMotion motion;
  motion.goal_ = goal;
  motion.translation_ = SynchronisedMotion::plan(start.head(translations), start_velocity.head(translations),
                                                 goal.head(translations), limits.translation);
  motion.rotation_ = SynchronisedMotion::plan(start.tail(rotations), start_velocity.tail(rotations),
                                              goal.tail(rotations), limits.rotation);
  motion.valid_ = motion.translation_.valid() && (rotations == 0 || motion.rotation_.valid());
  return motion.valid_ ? motion : resting;
}

double PoseMotion::duration() const noexcept {
  return std::max(translation_.duration(), rotation_.duration());
}

PlatformReference PoseMotion::evaluate(double time) const noexcept {
  const PlatformVector rest = PlatformVector::Zero(goal_.size());
  if (!valid_ || std::isnan(time)) return {false, false, goal_, rest, rest};
  const VectorMotion moved = translation_.evaluate(time), turned = rotation_.evaluate(time);
  return {true, time >= duration(), stacked(moved.position, turned.position),
          stacked(moved.velocity, turned.velocity), stacked(moved.acceleration, turned.acceleration)};
}

}  // namespace flinch
