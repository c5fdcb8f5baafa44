#include "systems/motion/waypoint_circuit.h"

#include <algorithm>
#include <cmath>

#include "systems/motion/chart_motion.h"

namespace flinch {
namespace {

bool are_usable(const ConfigurationSpace& space, std::span<const Configuration> waypoints) {
  return waypoints.size() >= 2 && waypoints.size() <= WaypointCircuit::max_waypoints &&
         std::all_of(waypoints.begin(), waypoints.end(),
                     [&space](const Configuration& pose) { return space.contains(pose); });
}

/// Limits on the share of a displacement, 0 to 1, that keep those of the displacement itself. A displacement
/// of zero has no such limits; its share takes any time.
MotionLimits of_share(const MotionLimits& limits, double displacement) {
  return {limits.velocity / displacement, limits.acceleration / displacement, limits.jerk / displacement};
}

MotionLimits smaller(const MotionLimits& a, const MotionLimits& b) {
  return {std::min(a.velocity, b.velocity), std::min(a.acceleration, b.acceleration),
          std::min(a.jerk, b.jerk)};
}

JerkLimitedProfile plan_share(const PlatformVector& displacement, int translations,
                              const PoseLimits& limits) {
  const double moved = displacement.head(translations).stableNorm();
  const double turned = displacement.tail(displacement.size() - translations).stableNorm();
  if (moved == 0 && turned == 0) return JerkLimitedProfile::plan({}, 0.0, limits.translation);
  return JerkLimitedProfile::plan(
      {}, 1.0, smaller(of_share(limits.translation, moved), of_share(limits.rotation, turned)));
}

}  // namespace

WaypointCircuit WaypointCircuit::plan(const ConfigurationSpace& space,
                                      std::span<const Configuration> waypoints, const PoseLimits& limits,
                                      int laps) noexcept {
  WaypointCircuit resting;
  resting.space_ = space;
  if (!waypoints.empty()) resting.first_ = waypoints.front();
  if (!are_usable(space, waypoints) || laps < 1) return resting;

  WaypointCircuit circuit = resting;
  circuit.count_ = static_cast<int>(waypoints.size());
  circuit.laps_ = laps;
  circuit.valid_ = can_be_planned_with(limits.translation) && can_be_planned_with(limits.rotation);
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    Leg& leg = circuit.legs_[i];
    leg.start = waypoints[i];
    leg.displacement = space.difference(waypoints[(i + 1) % waypoints.size()], leg.start);
    leg.share = plan_share(leg.displacement, space.translations(), limits);
    leg.begin = circuit.lap_duration_;
    circuit.lap_duration_ += leg.share.duration();
    circuit.valid_ = circuit.valid_ && leg.share.valid();
  }
  return circuit.valid_ ? circuit : resting;
}

PlatformReference WaypointCircuit::evaluate(double time) const noexcept {
  const PlatformVector rest = PlatformVector::Zero(space_ ? space_->dimension() : 0);
  const bool usable = valid_ && !std::isnan(time);
  const bool finished = usable && time >= duration();
  if (!usable || finished || time <= 0) return {usable, finished, first_, rest, rest};
  const double lap = std::min(std::floor(time / lap_duration_), laps_ - 1.0);
  const double in_lap = time - lap * lap_duration_;
  const auto later = std::find_if(legs_.begin() + 1, legs_.begin() + count_,
                                  [in_lap](const Leg& leg) { return in_lap < leg.begin; });
  const Leg& leg = *(later - 1);
  const ScalarMotion share = leg.share.evaluate(in_lap - leg.begin);
  return chart_motion(*space_, leg.start, share.position * leg.displacement,
                      share.velocity * leg.displacement, share.acceleration * leg.displacement);
}

std::array<Configuration, 4> square_corners(const Configuration& centre, double side) noexcept {
  std::array<Configuration, 4> corners;
  corners.fill(centre);
  const double half = side / 2;
  const std::array<std::array<double, 2>, 4> offsets{
      {{-half, -half}, {half, -half}, {half, half}, {-half, half}}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i](0) += offsets[i][0];
    corners[i](1) += offsets[i][1];
  }
  return corners;
}

}  // namespace flinch
