#include "systems/model/forward_kinematics.h"

#include <string>
#include <vector>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

std::vector<std::string> problems(const ForwardKinematicsSettings& settings, const ParallelRobot& robot) {
  Findings found;
  found.positive("largest_closure_error", settings.largest_closure_error, "m");
  found.require(!settings.initial_pose ||
                    robot.inverse_kinematics(*settings.initial_pose, robot.home_working_mode()).reachable,
                "initial_pose is out of reach of the legs");
  return found.take();
}

bool is_usable(const JointMotion& motion, int drives) {
  return motion.valid && motion.position.size() == drives && motion.position.allFinite() &&
         motion.velocity.size() == drives && motion.velocity.allFinite();
}

}  // namespace

ForwardKinematics::ForwardKinematics(std::shared_ptr<const ParallelRobot> robot,
                                     const ForwardKinematicsSettings& settings)
    : robot_(std::move(robot)), settings_(settings), mode_(robot_->home_working_mode()) {
  throw_if_any(problems(settings, *robot_));
  update<&ForwardKinematics::keep>(Every{settings.sampling.period}, previous_, platform, previous_, clock);
}

std::optional<Configuration> ForwardKinematics::start_pose(const JointMotion& active,
                                                           const JointVector* passive,
                                                           const ForwardKinematicsMemory& previous) const {
  const bool prefer_previous = settings_.start == ForwardKinematicsStart::previous_pose;
  if (previous.valid && (prefer_previous || passive == nullptr)) return previous.pose;
  if (passive != nullptr) return robot_->start_pose(active.position, *passive);
  if (!settings_.initial_pose && robot_->passive_joints() == 0) return robot_->home_pose();
  return settings_.initial_pose;
}

PlatformMotion::Status ForwardKinematics::solve_pose(const JointMotion& active, const JointReading& reading,
                                                     const ForwardKinematicsMemory& previous,
                                                     Configuration& pose) const {
  using Status = PlatformMotion::Status;
  if (!is_usable(active, robot_->drives())) return Status::no_data;
  const bool passive_usable =
      reading.passive_valid && robot_->passive_joints() > 0 && reading.acquired == active.acquired;
  const JointVector* passive = passive_usable ? &reading.passive : nullptr;
  const std::optional<Configuration> start = start_pose(active, passive, previous);
  if (!start) return Status::no_data;

  const ForwardSolution solution = robot_->forward_kinematics(active.position, *start, mode_);
  if (!solution.converged && !solution.other_branch) return Status::not_converged;
  pose = solution.pose;
  if (solution.other_branch) return Status::implausible;
  if (passive == nullptr) return Status::valid;
  const double closure_error = robot_->chain_closure_error(active.position, *passive, pose);
  return closure_error <= settings_.largest_closure_error ? Status::valid : Status::implausible;
}

void ForwardKinematics::solve(const JointMotion& active, const JointReading& reading,
                              const ForwardKinematicsMemory& previous, PlatformMotion& result) const {
  result.acquired = active.acquired;
  result.pose = robot_->space().origin();
  result.velocity.setZero(robot_->dof());
  result.status = solve_pose(active, reading, previous, result.pose);
  if (!result.valid()) return;

  const auto velocity = robot_->platform_velocity(result.pose, active.velocity, mode_);
  if (velocity) {
    result.velocity = *velocity;
  } else {
    result.status = PlatformMotion::Status::singular;
  }
}

ForwardKinematicsMemory ForwardKinematics::keep(const PlatformMotion& result,
                                                const ForwardKinematicsMemory& previous, Time now) const {
  if (result.valid()) return {true, now, result.pose};
  return settings_.sampling.expired(previous.arrived, now) ? ForwardKinematicsMemory() : previous;
}

}  // namespace flinch
