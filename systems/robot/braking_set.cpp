#include "systems/robot/braking_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flinch {
namespace {

constexpr int places = 10;

/// The largest u >= 0 for which every |known + u per_rate| is at most `most`; negative where there is none.
double largest_rate(const JointVector& known, const JointVector& per_rate, double most) {
  double largest = std::numeric_limits<double>::infinity();
  double least = 0.0;
  for (Eigen::Index i = 0; i < known.size(); ++i) {
    const double slope = per_rate[i];
    if (slope == 0.0) {
      if (std::abs(known[i]) > most) return -1.0;
      continue;
    }
    const double one = (most - known[i]) / slope, other = (-most - known[i]) / slope;
    largest = std::min(largest, std::max(one, other));
    least = std::max(least, std::min(one, other));
  }
  return largest >= least ? largest : -1.0;
}

bool is_inside(const Mechanism& robot, const Kinematics& at, const PoseConstraints& limits) {
  return at.sigma_kappa <= limits.max_condition_number && is_within(limits.workspace, robot, at);
}

}  // namespace

StraightStop straight_stop(const Mechanism& robot, const Kinematics& at, const Dynamics& dynamics,
                           const PoseConstraints& limits, double max_torque) noexcept {
  StraightStop stop;
  if (!at.valid || !dynamics.valid) return stop;
  const PlatformVector& v = at.velocity;
  const PlatformVector known = dynamics.C_x * v + dynamics.g_x + dynamics.F_fr_x;
  const double rate = largest_rate(at.J_x_qa.transpose() * known,
                                   at.J_x_qa.transpose() * PlatformVector(-dynamics.M_x * v), max_torque);
  if (!(rate > 0.0)) return stop;
  stop.duration = 1.0 / rate;
  stop.stays_inside = is_inside(robot, at, limits);
  const PlatformVector rest = PlatformVector::Zero(v.size());
  Kinematics on_the_way;
  for (int k = 1; k <= places && stop.stays_inside; ++k) {
    const double share = static_cast<double>(k) / places;
    const PlatformVector way = stop.duration * (share - 0.5 * share * share) * v;
    robot.kinematics(robot.space().plus(at.pose, way), rest, on_the_way);
    stop.stays_inside = is_inside(robot, on_the_way, limits);
  }
  return stop;
}

}  // namespace flinch
