#include "systems/motion/platform_trajectory.h"

#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {

using Phase = PlatformTrajectory::Course::Phase;

namespace {

Time arrival(const PlatformTrajectory::Course& course) {
  return course.begin + from_seconds(course.to_start.duration());
}

bool must_wait(const StartCommand& command, const DriveCheckStatus& checked) {
  return command.start && checked.holds_motion();
}

}  // namespace

PlatformTrajectory::PlatformTrajectory(std::shared_ptr<const ParallelRobot> robot,
                                       PlatformTrajectorySettings settings)
    : robot_(std::move(robot)), settings_(std::move(settings)) {
  for (const PoseLimits& limits : {settings_.approach, settings_.recovery}) {
    if (!can_be_planned_with(limits.translation) || !can_be_planned_with(limits.rotation)) {
      throw SetupError("platform trajectory: the limits of approach and recovery must be positive");
    }
  }
}

bool PlatformTrajectory::turns(Time now, const Course& last, const ReactionState& state,
                               const StartCommand& command, const TargetCommand& wanted,
                               const DriveCheckStatus& checked) const {
  return state.entered(ReactionMode::nominal, now) || state.entered(ReactionMode::recover, now) ||
         has_arrived(now, last) || wanted.number != last.target ||
         (state.mode == ReactionMode::nominal &&
          (starts(now, last, command, checked) || must_wait(command, checked)));
}

bool PlatformTrajectory::has_arrived(Time now, const Course& course) const {
  return course.phase == Phase::approach && now >= arrival(course);
}

void PlatformTrajectory::advance(Time now, const Course& last, const ReactionState& state,
                                 const PlatformMotion& motion, const StartCommand& command,
                                 const TargetCommand& wanted, const DriveCheckStatus& checked,
                                 Course& course) const {
  course = last;
  course.target = wanted.number;
  const bool recovered = state.previous == ReactionMode::recover;
  const bool recovers = state.mode == ReactionMode::recover;
  if (state.entered(ReactionMode::recover, now) ||
      (state.entered(ReactionMode::nominal, now) && !recovered)) {
    course = {.phase = Phase::hold,
              .begin = now,
              .to_start = rest_at(motion),
              .automatic = !recovers && last.phase == Phase::none,
              .target = wanted.number};
  }
  if (wanted.number != last.target && (recovers || state.mode == ReactionMode::nominal)) {
    PlatformReference present;
    evaluate(now, course, present);
    const PoseMotion way = way_to(wanted, present, recovers ? settings_.recovery : settings_.approach);
    if (way.valid()) {
      course = {
          .phase = Phase::hold, .begin = now, .to_start = way, .automatic = false, .target = wanted.number};
    }
  }
  if (state.mode == ReactionMode::nominal && must_wait(command, checked)) course.waits = true;
  if (state.mode == ReactionMode::nominal && starts(now, course, command, checked)) {
    course = {.phase = Phase::approach,
              .begin = now,
              .to_start = way_to_path(now, course),
              .automatic = false,
              .target = wanted.number};
  }
  if (has_arrived(now, course)) {
    course.phase = Phase::path;
    course.begin = arrival(course);
  }
}

PoseMotion PlatformTrajectory::rest_at(const PlatformMotion& motion) const {
  if (!motion.valid()) return {};
  return PoseMotion::plan(robot_->space(), motion.pose, motion.velocity, PlatformVector::Zero(robot_->dof()),
                          settings_.approach);
}

bool PlatformTrajectory::starts(Time now, const Course& course, const StartCommand& command,
                                const DriveCheckStatus& checked) const {
  const bool by_itself = course.automatic && settings_.start && now >= *settings_.start;
  const bool wanted = command.start || course.waits || by_itself;
  if (!settings_.path || checked.holds_motion() || !wanted) return false;
  PlatformReference present;
  evaluate(now, course, present);
  return present.valid && present.finished;
}

PoseMotion PlatformTrajectory::way_to_path(Time now, const Course& course) const {
  PlatformReference present;
  evaluate(now, course, present);
  return PoseMotion::plan(robot_->space(), present.pose, present.velocity,
                          robot_->difference(settings_.path->start(), present.pose), settings_.approach);
}

/// Not valid for what is no target.
PoseMotion PlatformTrajectory::way_to(const TargetCommand& wanted, const PlatformReference& present,
                                      const PoseLimits& limits) const {
  const ConfigurationSpace& space = robot_->space();
  if (!present.valid || is_faster(present.velocity, space.translations(), limits)) return {};
  PlatformVector way;
  if (wanted.kind == TargetCommand::Kind::step) way = wanted.step;
  if (wanted.kind == TargetCommand::Kind::pose && space.contains(wanted.pose)) {
    way = space.difference(wanted.pose, present.pose);
  }
  if (way.size() != robot_->dof() || !way.allFinite()) return {};
  const PoseMotion motion = PoseMotion::plan(space, present.pose, present.velocity, way, limits);
  const bool reachable =
      motion.valid() && robot_->inverse_kinematics(motion.goal(), robot_->home_working_mode()).reachable;
  return reachable ? motion : PoseMotion();
}

void PlatformTrajectory::evaluate(Time now, const Course& course, PlatformReference& result) const {
  const double time = to_seconds(now - course.begin);
  switch (course.phase) {
    case Phase::none:
      result = {};
      break;
    case Phase::hold:
      result = course.to_start.evaluate(time);
      break;
    case Phase::approach:
      result = course.to_start.evaluate(time);
      result.finished = false;
      break;
    case Phase::path:
      result = settings_.path->evaluate(time);
      break;
  }
}

}  // namespace flinch
