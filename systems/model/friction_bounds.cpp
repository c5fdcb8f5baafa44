#include "systems/model/friction_bounds.h"

#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

constexpr double closed = 0.05;   // as far open counts as not at all
constexpr Time forgotten = 50ms;  // longer gaps between samples begin anew

}  // namespace

FrictionBounds::FrictionBounds(const Mechanism& robot, const FrictionBoundsSettings& settings)
    : settings_(settings) {
  for (int i = 0; i < robot.drives(); ++i) {
    const bool turns = robot.drive_kind(i) == DriveKind::revolute;
    drives_.push_back({robot.dry_friction(i), turns ? settings.presliding : settings.sliding_presliding});
  }
}

void FrictionBounds::follow(Time acquired, const JointVector& rate, const FrictionBoundsMemory& memory,
                            FrictionBoundsMemory& next) const {
  const bool continued =
      memory.started && acquired - memory.acquired < forgotten && memory.open.size() == rate.size();
  const double T = continued ? to_seconds(acquired - memory.acquired) : 0.0;
  const double remains = std::exp(-T / to_seconds(settings_.closing));
  next.started = true;
  next.acquired = acquired;
  if (continued) {
    next.open = memory.open, next.direction = memory.direction, next.gone = memory.gone;
  } else {
    next.open.setOnes(rate.size());
    next.direction.setZero(rate.size());
    next.gone.setZero(rate.size());
  }
  for (int i = 0; i < rate.size(); ++i) {
    const Drive& drive = drives_[static_cast<std::size_t>(i)];
    const double relative = drive.friction.effort > 0.0 ? rate[i] / drive.friction.velocity : 0.0;
    if (std::abs(relative) > settings_.turns && relative * next.direction[i] <= 0.0) {
      next.direction[i] = std::copysign(1.0, relative);
      next.gone[i] = 0.0;
    }
    next.gone[i] = std::min(next.gone[i] + T * std::abs(rate[i]), 2.0 * drive.presliding);
    const double slow = std::clamp(2.0 * (1.0 - std::abs(relative) / settings_.slow), 0.0, 1.0);
    const bool builds_up = next.direction[i] != 0.0 && next.gone[i] < drive.presliding;
    next.open[i] = builds_up ? 1.0 : std::max(slow, next.open[i] * remains);
    if (next.open[i] < closed) next.open[i] = 0.0;
  }
}

FrictionInterval FrictionBounds::interval(const JointVector& rate, const FrictionBoundsMemory& memory) const {
  FrictionInterval bounds;
  bounds.low.setZero(rate.size());
  bounds.high.setZero(rate.size());
  for (int i = 0; i < rate.size(); ++i) {
    const DryFriction& friction = drives_[static_cast<std::size_t>(i)].friction;
    const double most = settings_.share * friction.effort, model = friction.at(rate[i]);
    bounds.low[i] = memory.open[i] * (model - most);
    bounds.high[i] = memory.open[i] * (model + most);
  }
  return bounds;
}

}  // namespace flinch
