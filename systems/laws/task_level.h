#pragma once

#include <cstdint>

#include "systems/laws/task_priority.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/signals/task_list.h"

/// Tasks by priority on the three levels of [SafePR] IV-D and IV-E. On each a law has two halves: the tasks
/// give a reference, which is what is blended where tasks change, and the reference gives torques.
namespace flinch {

/// What a task controller commands, and so in which metric tasks share what is left.
enum class TaskLevel : std::uint8_t {
  velocity,      ///< dq_a, [SafePR] (32)
  acceleration,  ///< ddq_a, [SafePR] (33)
  torque,        ///< wrench of the platform, dynamically consistent, [SafePR] (34)-(46)
};

struct TaskLevelSettings {
  DampedInverseSettings inverse;
  PriorityForm priorities = PriorityForm::recursive;  ///< Of all levels.
  /// What the tasks leave free is braked: ddx = -damping dx [1/s]. On the velocity level it stands still.
  double free_damping = 20.0;

  // Units of a turning drive, of a sliding one in brackets.
  double velocity_feedforward = 1.0;    ///< K_qa dt, of (32e) [Nms/rad] ([Ns/m])
  double velocity_gain = 60.0;          ///< D_qa, of (32e) [Nms/rad] ([Ns/m])
  double largest_acceleration = 100.0;  ///< of a drive's reference [rad/s^2] ([m/s^2])
  double largest_torque = 100.0;        ///< of a drive [Nm] ([N])
  double largest_torque_rate = 20e3;    ///< of a drive, so that no switch makes a step [Nm/s] ([N/s])
};

/// What the tasks of `list` want together, one entry a drive or platform coordinate: dq_a,ref [rad/s],
/// ddq_a,ref [rad/s^2], or F_ref [N, Nm] without compensation of the robot's own dynamics. Tasks that are not
/// valid are passed over. `constrained`: it begins with constraints; see wrench_reference().
///
///   velocity       dsigma_ref = dsigma_d + k e
///   acceleration  ddsigma_ref = ddsigma_d + k e + d de
///   torque        ddsigma_ref = ddsigma_d + M_i^-1 (K_F e + D_F de),   M_i^-1 = J_i M_x^-1 J_i^T
///
/// each less the task's drift, which (44b) omits: so it stays in there on the torque level where priorities
/// are as printed. D_F is the factorisation damping (46) with its fallback.
PlatformVector task_reference(TaskLevel level, const TaskList& list, const Kinematics& kinematics,
                              const Dynamics& dynamics, const TaskLevelSettings& settings,
                              bool constrained = false) noexcept;

/// The torques that follow a reference, those of the robot's own dynamics added:
///
///   velocity      tau = K_qa dt dq_a,ref + D_qa (dq_a,ref - dq_a) + b_qa
///   acceleration  tau = M_qa ddq_a,ref + b_qa
///   torque        tau = J_x,qa^T (F_ref + b_x)
///
/// with b = C dq + g + friction in the coordinates of the drives or of the platform; where priorities are as
/// printed, tau = J_x,qa^T F_ref + b_qa on the torque level too, as (44c) has it.
///
/// What the tasks ask for is reduced, in its direction, until no torque exceeds the largest.
JointVector task_torque(TaskLevel level, const PlatformVector& reference, const Kinematics& kinematics,
                        const Dynamics& dynamics, const TaskLevelSettings& settings) noexcept;

/// M_i of a task with the mobility M_i^-1 = J_i M_x^-1 J_i^T. Directions in which the task can hardly be
/// moved count as a little mobile.
PlatformMatrix task_inertia(const PlatformMatrix& mobility) noexcept;

/// `wanted` made shorter, in its direction, so that no entry of known + wanted exceeds `largest`; where that
/// of `known` alone does, known + wanted clamped.
JointVector saturated(const JointVector& known, const JointVector& wanted, double largest) noexcept;

}  // namespace flinch
