#pragma once

#include "systems/robot/planar_rrr.h"
#include "systems/robot/self_collision_tasks.h"
#include "systems/robot/task.h"

/// sigma_sc of a planar 3-RRR in closed form. With omega_j the angle of the second link of leg j away from
/// the radius of its coupling joint, and coupling joints 120 degrees apart at r_c:
///
///   sigma_sc = sqrt(3) r_c                              where no |omega_j| exceeds 60 degrees
///   sigma_sc = sqrt(3) r_c cos(max |omega_j| - 60 deg)  beyond
///
/// exact wherever sigma_sc > 0.1 m on the rig. So sigma_sc >= s is the same as omega_j <= omega_max(s) for
/// every leg: smooth functions without plateau and ties. Only positive omega_j come near.
namespace flinch {

/// sigma = omega_j = theta2_j + pi - phi - beta_j, in (-pi, pi] [rad].
Task coupling_angle_task(const PlanarRrr& robot, const Kinematics& kinematics, int leg) noexcept;

/// omega_max: the largest omega_j at which sigma_sc is `distance` [rad]; 60 degrees where it never is as
/// large. `distance` must not be negative [m].
double largest_coupling_angle(const PlanarRrr& robot, double distance) noexcept;

/// All omega_j, and the largest one at which sigma_sc is `distance` [m]; none where that is not exact, below
/// 0.1 m.
SelfCollisionTasks coupling_angles(const PlanarRrr& robot, const Kinematics& kinematics,
                                   double distance) noexcept;

}  // namespace flinch
