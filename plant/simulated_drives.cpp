#include "plant/simulated_drives.h"

#include "plant/setting_problems.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

std::vector<std::string> problems(const SimulatedDrivesSettings& settings) {
  SettingProblems problems("drives.");
  for (int i = 0; i < 3; ++i) {
    problems.require_positive("torque_constant", settings.torque_constant[i]);
    problems.require_positive("driver_torque_constant", settings.driver_torque_constant[i]);
  }
  problems.require_positive("torque_limit", settings.torque_limit);
  problems.require_not_negative("longest_silence [s]", to_seconds(settings.longest_silence));
  return problems.found();
}

SimulatedDrives::SimulatedDrives(const SimulatedDrivesSettings& settings) : settings_(settings) {
  throw_if_any(problems(settings));
}

DriveAction SimulatedDrives::act(Time now, const TorqueCommand& command, const BrakeCommand& brakes) const {
  const Time age = now - command.computed;
  const bool fresh = age >= Time::zero() && age <= settings_.longest_silence;
  const bool usable = command.valid && fresh && command.torque.size() == 3 && command.torque.allFinite();
  if (!usable || brakes.engage) return DriveAction();

  DriveAction action;
  const Eigen::Vector3d wanted =
      command.torque.cwiseMax(-settings_.torque_limit).cwiseMin(settings_.torque_limit);
  action.current = wanted.cwiseQuotient(settings_.driver_torque_constant);
  action.torque = settings_.torque_constant.cwiseProduct(action.current);
  action.enabled = true;
  action.braked = false;
  return action;
}

StationStatus SimulatedDrives::report(Time now, const DriveAction& action, const PlantTruth& robot) const {
  return {
      .acquired = now, .valid = true, .enabled = robot.valid, .braked = action.braked, .fault = !robot.valid};
}

}  // namespace flinch
