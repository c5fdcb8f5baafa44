#include "systems/robot/planar_self_collision.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "systems/robot/angles.h"

namespace flinch {

// q_c = phi - theta2, so that d omega = -d q_c.
Task coupling_angle_task(const PlanarRrr& robot, const Kinematics& kinematics, int leg) noexcept {
  Task task = no_task(1, 3);
  if (!kinematics.reachable || leg < 0 || leg >= 3 || kinematics.joints.coupling.size() != 3) return task;
  const double beta = robot.parameters().legs[static_cast<std::size_t>(leg)].coupling_angle;
  task.sigma[0] = wrap_angle(std::numbers::pi - kinematics.joints.coupling[leg] - beta);
  task.J = -kinematics.J_qc_x.row(leg);
  task.drift = -kinematics.dJ_qc_x.row(leg) * kinematics.velocity;
  task.valid = true;
  return task;
}

double largest_coupling_angle(const PlanarRrr& robot, double distance) noexcept {
  const double plateau = std::numbers::sqrt3 * robot.parameters().coupling_radius;
  return std::numbers::pi / 3.0 + std::acos(std::clamp(distance / plateau, 0.0, 1.0));
}

SelfCollisionTasks coupling_angles(const PlanarRrr& robot, const Kinematics& kinematics,
                                   double distance) noexcept {
  constexpr double exact_from = 0.1;  // [m]
  SelfCollisionTasks angles;
  if (distance < exact_from) return angles;
  angles.count = robot.legs();
  angles.largest = largest_coupling_angle(robot, distance);
  for (int leg = 0; leg < angles.count; ++leg)
    angles.tasks[static_cast<std::size_t>(leg)] = coupling_angle_task(robot, kinematics, leg);
  return angles;
}

}  // namespace flinch
