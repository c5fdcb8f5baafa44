#include "diagrams/robot_constraints.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "systems/robot/link_segments.h"

namespace flinch {
namespace {

constexpr double activation_over_home = 1.5, safety_over_home = 1.9;  // of sigma_kappa
constexpr double activation_way = 0.5, safety_way = 0.75;  // of sigma_sc, from home to where links touch

/// Half the thickness of the thickest capsule of a link [m].
double radius_of(const Body& link) {
  double radius = 0.0;
  for (const Shape& shape : link.shapes) {
    if (const auto* const capsule = std::get_if<Capsule>(&shape)) radius = std::max(radius, capsule->radius);
  }
  return radius;
}

/// Distance of axes at which the two thickest links touch that may meet [m].
double touching_distance(const Mechanism& mechanism) {
  double largest = 0.0;
  for (const BodyPair& pair : mechanism.description().self_collision_pairs) {
    const auto radius = [&](int body) {
      return radius_of(mechanism.description().bodies[static_cast<std::size_t>(body)]);
    };
    largest = std::max(largest, radius(pair.a) + radius(pair.b));
  }
  return largest;
}

}  // namespace

ConstraintSettings constraints_for(const ParallelRobot& robot, const WorkspaceLimits& limits) {
  Kinematics home;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), home);
  ConstraintSettings settings;
  if (home.sigma_kappa >= settings.sigma_kappa.activation) {
    settings.sigma_kappa.activation = activation_over_home * home.sigma_kappa;
    settings.sigma_kappa.safety = safety_over_home * home.sigma_kappa;
  }
  const double apart = self_collision_distance(robot, home);
  if (apart > settings.sigma_sc.activation) return settings;
  double touching = std::max(limits.min_self_collision_distance, touching_distance(robot));
  if (touching >= apart) touching = 0.5 * apart;
  settings.sigma_sc.activation = apart + activation_way * (touching - apart);
  settings.sigma_sc.safety = apart + safety_way * (touching - apart);
  return settings;
}

}  // namespace flinch
