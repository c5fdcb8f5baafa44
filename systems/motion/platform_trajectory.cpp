#include "systems/motion/platform_trajectory.h"

#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {

using Phase = PlatformTrajectory::Course::Phase;

namespace {

Time arrival(const PlatformTrajectory::Course& course) {
  return course.begin + from_seconds(course.to_start.duration());
}

}  // namespace

PlatformTrajectory::PlatformTrajectory(std::shared_ptr<const ParallelRobot> robot,
                                       PlatformTrajectorySettings settings)
    : robot_(std::move(robot)), settings_(std::move(settings)) {
  if (!can_be_planned_with(settings_.approach.translation) ||
      !can_be_planned_with(settings_.approach.rotation)) {
    throw SetupError("platform trajectory: the limits of the approach must be positive");
  }
}

bool PlatformTrajectory::turns(Time now, const Course& last, const ReactionState& state,
                               const StartCommand& command) const {
  return state.entered(ReactionMode::nominal, now) || has_arrived(now, last) ||
         (state.mode == ReactionMode::nominal && starts(now, last, command));
}

bool PlatformTrajectory::has_arrived(Time now, const Course& course) const {
  return course.phase == Phase::approach && now >= arrival(course);
}

void PlatformTrajectory::advance(Time now, const Course& last, const ReactionState& state,
                                 const PlatformMotion& motion, const StartCommand& command,
                                 Course& course) const {
  course = last;
  if (state.entered(ReactionMode::nominal, now)) {
    course = {.phase = Phase::hold,
              .begin = now,
              .to_start = rest_at(motion),
              .automatic = last.phase == Phase::none};
  }
  if (state.mode == ReactionMode::nominal && starts(now, course, command)) {
    course = {
        .phase = Phase::approach, .begin = now, .to_start = way_to_path(now, course), .automatic = false};
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

bool PlatformTrajectory::starts(Time now, const Course& course, const StartCommand& command) const {
  const bool by_itself = course.automatic && settings_.start && now >= *settings_.start;
  if (!settings_.path || !(command.start || by_itself)) return false;
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
