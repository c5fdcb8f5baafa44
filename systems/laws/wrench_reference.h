#pragma once

#include "systems/laws/task_level.h"

namespace flinch {

/// The torque level's half of task_reference(): F_ref [N, Nm]. `constrained`: the list begins with
/// constraints.
///
/// What the list leaves free is braked. Where it moves part of the platform, the rest follows as little as it
/// can, in metres and radians: ddx is as near to -free_damping dx as the list lets it be. That holds against
/// what the list wants, and so may put energy in. Beside constraints, which may want much more than a motion
/// that was planned, it is a damping only,
///
///   F_free = -free_damping (M_x - J^T (J M_x^-1 J^T)^-1 J) dx,   F_free^T dx <= 0.
///
/// (Derived.)
PlatformVector wrench_reference(const TaskList& list, bool constrained, const Kinematics& kinematics,
                                const Dynamics& dynamics, const TaskLevelSettings& settings) noexcept;

/// How a task errs that moves with the platform.
struct TaskError {
  PlatformVector e;
  PlatformVector de;
};
TaskError error_of(const TaskGoal& goal, const PlatformVector& velocity) noexcept;

}  // namespace flinch
