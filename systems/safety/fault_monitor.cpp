#include "systems/safety/fault_monitor.h"

#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {
FaultMonitor::FaultMonitor(std::shared_ptr<const ParallelRobot> robot, const FaultLimits& limits)
    : robot_(std::move(robot)), limits_(limits) {
  throw_if_any(problems(limits, *robot_));
  Kinematics home;
  robot_->kinematics(robot_->home_pose(), PlatformVector::Zero(robot_->dof()), home);
  if (home.det_A < 0.0) home_side_ = -1.0;
}

WorkspaceMeasures FaultMonitor::seen_from_home(WorkspaceMeasures seen) const {
  seen.det_A *= home_side_;
  return seen;
}

void FaultMonitor::advance(Time now, const FaultMonitorMemory& last, const StationStatus& status,
                           const JointReading& angles, const DriveReading& currents, const JointMotion& rates,
                           const PlatformMotion& pose, const Kinematics& kinematic,
                           const WorkspaceMeasures& workspace, const TorqueCommand& asked,
                           const ReactionState& state, FaultMonitorMemory& next) const {
  next = last;
  if (status.valid) next.station = now;
  if (is_usable(angles, *robot_)) next.joints = now;
  if (is_usable(currents, *robot_)) next.drives = now;
  next.last_command = last.command;
  next.command = asked;
  flinch::advance(next.encoders, {.robot = *robot_,
                                  .joints = angles,
                                  .platform = pose,
                                  .kinematics = kinematic,
                                  .drives = currents,
                                  .braked = status.valid && status.braked});
  flinch::advance(next.recovery,
                  {.robot = *robot_,
                   .limits = limits_.workspace,
                   .motion = rates,
                   .platform = pose,
                   .measures = seen_from_home(workspace)},
                  state.mode == ReactionMode::recover);
}

FaultReport FaultMonitor::judge(Time now, const FaultMonitorMemory& memory, const TickTiming& tick,
                                const StationStatus& status, const JointReading& angles,
                                const DriveReading& currents, const JointMotion& rates,
                                const PlatformMotion& pose, const WorkspaceMeasures& workspace,
                                const ContactDetection& contact, const PlatformReference& followed,
                                const OperatorCommand& pressed, const ReactionState& state,
                                const Plausibility& plausible, const DriveCheckStatus& checked) const {
  const WorkspaceMeasures from_home = seen_from_home(workspace);
  const Evidence evidence{.robot = *robot_,
                          .limits = limits_,
                          .now = now,
                          .timing = tick,
                          .station = status,
                          .joints = angles,
                          .drives = currents,
                          .station_gap = now - memory.station,
                          .joints_gap = now - memory.joints,
                          .drives_gap = now - memory.drives,
                          .encoders = memory.encoders,
                          .motion = rates,
                          .platform = pose,
                          .measures = from_home,
                          .detection = contact,
                          .reference = followed,
                          .command = memory.command,
                          .last_command = memory.last_command,
                          .buttons = pressed,
                          .reaction = state,
                          .plausibility = plausible,
                          .drive_check = checked,
                          .has_motion = is_usable(rates, *robot_),
                          .has_pose = is_usable(pose, *robot_),
                          .has_command = is_usable(memory.command, *robot_)};
  return {.valid = true,
          .present = find_faults(evidence),
          .tolerable = tolerable_faults(memory.recovery, limits_.recovery_margin),
          .at_rest = evidence.has_motion && rates.rests(limits_.rest_speed)};
}

}  // namespace flinch
