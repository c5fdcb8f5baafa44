#include "plant/simulated_drives.h"

#include <algorithm>
#include <cmath>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/drive_parameters.h"

namespace flinch {

namespace {

void check_count(const JointVector& values, const std::string& name, int drives, Findings& found) {
  found.require(values.size() == 0 || values.size() == drives,
                name + " has " + std::to_string(values.size()) + " entries; the robot has " +
                    std::to_string(drives) + " drives");
}

}  // namespace

std::vector<std::string> problems(const SimulatedDrivesSettings& settings, const Mechanism& robot) {
  Findings found("drives.");
  check_count(settings.torque_constant, "torque_constant", robot.drives(), found);
  check_count(settings.driver_torque_constant, "driver_torque_constant", robot.drives(), found);
  check_count(settings.current_lag, "current_lag", robot.drives(), found);
  check_count(settings.torque_delay, "torque_delay", robot.drives(), found);
  check_count(settings.max_torque, "max_torque", robot.drives(), found);
  for (const double constant : settings.torque_constant) found.positive("torque_constant", constant);
  for (const double constant : settings.driver_torque_constant) {
    found.positive("driver_torque_constant", constant);
  }
  for (const double lag : settings.current_lag) found.not_negative("current_lag", lag, "s");
  for (const double delay : settings.torque_delay)
    found.at_most(longest_torque_delay, "torque_delay", std::abs(delay), "s");
  for (const double most : settings.max_torque) found.positive("max_torque", most);
  found.not_negative("longest_silence", to_seconds(settings.longest_silence), "s");
  return found.take();
}

SimulatedDrivesSettings complete(SimulatedDrivesSettings settings, const Mechanism& robot) {
  throw_if_any(problems(settings, robot));
  JointVector constant(robot.drives()), most(robot.drives());
  for (int i = 0; i < robot.drives(); ++i) {
    const DriveParameters usual = default_drives(robot.drive_kind(i), 1);
    constant[i] = usual.torque_constant[0];
    most[i] = usual.max_torque;
  }
  if (settings.torque_constant.size() == 0) settings.torque_constant = constant;
  if (settings.max_torque.size() == 0) settings.max_torque = most;
  if (settings.driver_torque_constant.size() == 0) settings.driver_torque_constant = settings.torque_constant;
  return settings;
}

SimulatedDrives::SimulatedDrives(const SimulatedDrivesSettings& settings, const Mechanism& robot, Time tick)
    : settings_(complete(settings, robot)), tick_(tick) {}

DriveAction SimulatedDrives::act(Time now, const DriveAction& before, const TorqueCommand& command,
                                 const BrakeCommand& brakes) const {
  const Time age = now - command.computed;
  const bool fresh = age >= Time::zero() && age <= settings_.longest_silence;
  const bool usable = command.valid && fresh && command.torque.size() == settings_.max_torque.size() &&
                      command.torque.allFinite();
  DriveAction action = at_rest();
  if (!usable || brakes.engage) {
    spoil(now, before, action);
    return action;
  }
  const JointVector wanted = command.torque.cwiseMax(-settings_.max_torque).cwiseMin(settings_.max_torque);
  action.current = wanted.cwiseQuotient(settings_.driver_torque_constant);
  JointVector mean = action.current;
  // i(t) = i_wanted + (i_before - i_wanted) exp(-t / lag), its mean over the tick, and its value at the end.
  for (int i = 0; i < settings_.current_lag.size(); ++i) {
    const double ticks = settings_.current_lag[i] / to_seconds(tick_);
    const double left = std::exp(-1.0 / ticks);
    const double step = before.current[i] - action.current[i];
    mean[i] += step * ticks * (1.0 - left);
    action.current[i] += step * left;
  }
  if (settings_.torque_delay.size() > 0) delay(before, action, mean);
  action.torque = settings_.torque_constant.cwiseProduct(mean);
  action.enabled = true;
  action.braked = false;
  spoil(now, before, action);
  return action;
}

/// Each torque is that of the mean current of a tick that ended so much earlier, as if the current changed
/// evenly from tick to tick.
void SimulatedDrives::delay(const DriveAction& before, DriveAction& action, JointVector& mean) const {
  action.currents.front() = {mean, action.current};
  std::copy(before.currents.begin(), before.currents.end() - 1, action.currents.begin() + 1);
  const double T = to_seconds(tick_);
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    const auto [whole, rest] = in_intervals(settings_.torque_delay[i], T);
    const DriveAction::TickCurrent &then = action.currents[whole], &from = action.currents[whole + 1];
    const double of_then = then.mean.size() > 0 ? then.mean[i] : 0.0;
    const double end = then.current.size() > 0 ? then.current[i] : 0.0;
    const double begin = from.current.size() > 0 ? from.current[i] : 0.0;
    mean[i] = of_then - rest * (end - begin) / T;
  }
}

/// What is commanded and what is measured of a current is not touched.
void SimulatedDrives::spoil(Time now, const DriveAction& before, DriveAction& action) const {
  action.since = action.braked == before.braked ? before.since : now;
  if (settings_.faults.empty()) return;
  action.hold.setConstant(settings_.max_torque.size(), action.braked ? 1.0 : 0.0);
  for (const RequestedFault& fault : settings_.faults) {
    for (int i = 0; i < settings_.max_torque.size() && now >= fault.begin; ++i) {
      if (fault.index && *fault.index != i) continue;
      const double size = fault.size.value_or(0.0);
      if (fault.signal == FaultSignal::drive && fault.kind == FaultKind::scaled) action.torque[i] *= size;
      if (fault.signal != FaultSignal::brake) continue;
      if (fault.kind == FaultKind::off) action.hold[i] = 0.0;
      if (fault.kind == FaultKind::stuck) action.hold[i] = 1.0;
      if (fault.kind == FaultKind::scaled) action.hold[i] *= size;
      if (fault.kind == FaultKind::delayed && now - action.since < from_seconds(size)) action.hold[i] = 0.0;
    }
  }
}

DriveAction SimulatedDrives::at_rest() const {
  DriveAction action;
  action.torque.setZero(settings_.max_torque.size());
  action.current.setZero(settings_.max_torque.size());
  return action;
}

StationStatus SimulatedDrives::report(Time now, const DriveAction& action, const PlantTruth& robot) const {
  return {
      .acquired = now, .valid = true, .enabled = robot.valid, .braked = action.braked, .fault = !robot.valid};
}

}  // namespace flinch
