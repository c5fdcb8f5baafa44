#include "systems/motion/pose_motion.h"

#include <algorithm>
#include <cmath>

#include "systems/motion/chart_motion.h"

namespace flinch {
namespace {

PlatformVector stacked(const PlatformVector& translation, const PlatformVector& rotation) {
  PlatformVector both(translation.size() + rotation.size());
  both << translation, rotation;
  return both;
}

}  // namespace

bool is_faster(const PlatformVector& velocity, int translations, const PoseLimits& limits) noexcept {
  constexpr double margin = 1.05;  // for a motion that just reaches them
  return velocity.head(translations).norm() > margin * limits.translation.velocity ||
         velocity.tail(velocity.size() - translations).norm() > margin * limits.rotation.velocity;
}

PoseMotion PoseMotion::plan(const ConfigurationSpace& space, const Configuration& start,
                            const PlatformVector& start_velocity, const PlatformVector& displacement,
                            const PoseLimits& limits) noexcept {
  PoseMotion resting;
  resting.space_ = space;
  resting.start_ = start;
  resting.displacement_.setZero(space.dimension());
  const int n = space.dimension();
  if (!space.contains(start) || start_velocity.size() != n || displacement.size() != n) return resting;

  PoseMotion motion = resting;
  motion.displacement_ = displacement;
  const PlatformVector rest = PlatformVector::Zero(n);
  const int translations = space.translations();
  const int rotations = space.rotations();
  motion.translation_ = SynchronisedMotion::plan(rest.head(translations), start_velocity.head(translations),
                                                 displacement.head(translations), limits.translation);
  motion.rotation_ = SynchronisedMotion::plan(rest.tail(rotations), start_velocity.tail(rotations),
                                              displacement.tail(rotations), limits.rotation);
  motion.valid_ = motion.translation_.valid() && (rotations == 0 || motion.rotation_.valid());
  return motion.valid_ ? motion : resting;
}

double PoseMotion::duration() const noexcept {
  return std::max(translation_.duration(), rotation_.duration());
}

PlatformReference PoseMotion::evaluate(double time) const noexcept {
  if (!valid_ || std::isnan(time)) {
    const PlatformVector rest = PlatformVector::Zero(displacement_.size());
    return {false, false, space_ && space_->contains(start_) ? goal() : start_, rest, rest};
  }
  const VectorMotion moved = translation_.evaluate(time), turned = rotation_.evaluate(time);
  PlatformReference reference = chart_motion(*space_, start_, stacked(moved.position, turned.position),
                                             stacked(moved.velocity, turned.velocity),
                                             stacked(moved.acceleration, turned.acceleration));
  reference.finished = time >= duration();
  return reference;
}

}  // namespace flinch
