#include "systems/laws/task_controller.h"

#include <string>
#include <utility>
#include <vector>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/laws/share_within.h"

namespace flinch {
namespace {

std::vector<std::string> problems(const TaskControllerSettings& settings) {
  Findings found("task controller: ");
  const TaskLevelSettings& levels = settings.levels;
  found.require(settings.blend >= Time::zero(), "blend must not be negative");
  found.require(levels.free_damping > 0, "free_damping must be positive");
  found.require(levels.velocity_gain > 0, "velocity_gain must be positive");
  found.require(levels.velocity_feedforward >= 0, "velocity_feedforward must not be negative");
  found.require(
      levels.largest_acceleration > 0 && levels.largest_torque > 0 && levels.largest_torque_rate > 0,
      "limits must be positive");
  return found.take();
}

// The constraints that are active in `mode`, then the tasks.
TaskList by_priority(ConstraintMode mode, const TaskList& constraints, const TaskList& tasks) {
  using enum ConstraintMode;
  TaskList list;
  if (constraints.count >= 2) {
    if (mode == condition_number || mode == condition_number_and_self_collision)
      list.add(constraints.goals[0]);
    if (mode == self_collision || mode == condition_number_and_self_collision) list.add(constraints.goals[1]);
  }
  for (const TaskGoal& goal : tasks) list.add(goal);
  return list;
}

}  // namespace

TaskController::TaskController(std::shared_ptr<const ParallelRobot> robot,
                               const TaskControllerSettings& settings)
    : robot_(std::move(robot)), settings_(settings) {
  throw_if_any(problems(settings));
}

TaskController::Blend TaskController::advanced(Time now, const Blend& last, ConstraintMode wanted) const {
  Blend next = last;
  if (wanted != last.to) {
    next.from = last.to;
    next.to = wanted;
    next.progress = Time::zero();
    next.frozen = last.weight < 1.0;
    if (next.frozen) next.held = last.reference;
  }
  next.tick = now;
  next.progress += now - last.tick;
  const bool done = next.progress >= settings_.blend;
  next.weight = done ? 1.0 : to_seconds(next.progress) / to_seconds(settings_.blend);
  return next;
}

void TaskController::blend(Time now, const Blend& last, const TaskList& list, const TaskList& kept,
                           const ConstraintState& state, const Kinematics& at, const Dynamics& model,
                           Blend& next) const {
  next = advanced(now, last, state.mode);
  if (!list.valid || !at.valid || !model.valid) {
    next.reference = PlatformVector();
    return;
  }
  const auto reference_of = [&](ConstraintMode mode) -> PlatformVector {
    const TaskList served = by_priority(mode, kept, list);
    const bool constrained = served.count > list.count;
    return task_reference(settings_.level, served, at, model, settings_.levels, constrained);
  };
  next.reference = reference_of(next.to);
  if (next.weight >= 1.0) return;
  const PlatformVector old = next.frozen ? next.held : reference_of(next.from);
  if (old.size() != next.reference.size()) return;
  next.reference = next.weight * next.reference + (1.0 - next.weight) * old;
}

void TaskController::drive(Time now, const TorqueCommand& last, const Blend& wanted, const Kinematics& at,
                           const Dynamics& model, TorqueCommand& command) const {
  command = {.computed = now, .valid = false, .torque = JointVector::Zero(robot_->drives())};
  if (wanted.reference.size() == 0 || !at.valid || !model.valid) return;
  command.torque = task_torque(settings_.level, wanted.reference, at, model, settings_.levels);
  if (last.valid && last.computed < now) {
    const JointVector change = command.torque - last.torque;
    const double most = settings_.levels.largest_torque_rate * to_seconds(now - last.computed);
    command.torque = last.torque + change * share_within(change, most);
  }
  command.valid = command.torque.allFinite();
}

}  // namespace flinch
