#include "plant/simulated_drives.h"

#include "plant/setting_problems.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

namespace {

void check(const JointVector& constants, const char* name, int drives, std::vector<std::string>& found) {
  if (constants.size() == 0) return;
  if (constants.size() != drives) {
    found.push_back(std::string("drives.") + name + " has " + std::to_string(constants.size()) +
                    " entries; the robot has " + std::to_string(drives) + " drives");
  }
  SettingProblems problems("drives.");
  for (const double constant : constants) problems.require_positive(name, constant);
  problems.append_to(found);
}

JointVector limits(const SimulatedDrivesSettings& settings, const Mechanism& robot) {
  JointVector limit(robot.drives());
  for (int i = 0; i < robot.drives(); ++i) {
    limit[i] = robot.drive_kind(i) == DriveKind::revolute ? settings.torque_limit : settings.force_limit;
  }
  return limit;
}

SimulatedDrivesSettings completed(SimulatedDrivesSettings settings, const Mechanism& robot) {
  throw_if_any(problems(settings, robot));
  constexpr double usual_constant = 6.1;
  if (settings.torque_constant.size() == 0)
    settings.torque_constant.setConstant(robot.drives(), usual_constant);
  if (settings.driver_torque_constant.size() == 0) settings.driver_torque_constant = settings.torque_constant;
  return settings;
}

}  // namespace

std::vector<std::string> problems(const SimulatedDrivesSettings& settings, const Mechanism& robot) {
  std::vector<std::string> found;
  check(settings.torque_constant, "torque_constant", robot.drives(), found);
  check(settings.driver_torque_constant, "driver_torque_constant", robot.drives(), found);
  SettingProblems problems("drives.");
  problems.require_positive("torque_limit", settings.torque_limit);
  problems.require_positive("force_limit", settings.force_limit);
  problems.require_not_negative("longest_silence [s]", to_seconds(settings.longest_silence));
  problems.append_to(found);
  return found;
}

SimulatedDrives::SimulatedDrives(const SimulatedDrivesSettings& settings, const Mechanism& robot)
    : settings_(completed(settings, robot)), limit_(limits(settings, robot)) {}

DriveAction SimulatedDrives::act(Time now, const TorqueCommand& command, const BrakeCommand& brakes) const {
  const Time age = now - command.computed;
  const bool fresh = age >= Time::zero() && age <= settings_.longest_silence;
  const bool usable =
      command.valid && fresh && command.torque.size() == limit_.size() && command.torque.allFinite();
  if (!usable || brakes.engage) return at_rest();

  DriveAction action;
  const JointVector wanted = command.torque.cwiseMax(-limit_).cwiseMin(limit_);
  action.current = wanted.cwiseQuotient(settings_.driver_torque_constant);
  action.torque = settings_.torque_constant.cwiseProduct(action.current);
  action.enabled = true;
  action.braked = false;
  return action;
}

DriveAction SimulatedDrives::at_rest() const {
  DriveAction action;
  action.torque.setZero(limit_.size());
  action.current.setZero(limit_.size());
  return action;
}

StationStatus SimulatedDrives::report(Time now, const DriveAction& action, const PlantTruth& robot) const {
  return {
      .acquired = now, .valid = true, .enabled = robot.valid, .braked = action.braked, .fault = !robot.valid};
}

}  // namespace flinch
