#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "calibration/calibration_output.h"
#include "experiments/verdict/verdict.h"
#include "identification/dynamics_calibration.h"
#include "identification/imu_pose_calibration.h"
#include "identification/torque_constant_calibration.h"
#include "systems/config/parameter_file.h"
#include "tests/identification/recorded.h"

namespace flinch::test {

/// What a calibration has found of how a drive cogs.
inline Cogging found_cogging(const CalibrationResult& result, int drive) {
  std::map<std::string, double> values;
  for (const CalibratedParameter& parameter : result.parameters) values[parameter.name] = parameter.value;
  const auto value = [&](const std::string& key) {
    return JointVector::Constant(1, values.at("drives." + key + "[" + std::to_string(drive) + "]"));
  };
  Cogging found;
  for (int wave = 0; values.contains("drives." + cogging_key(wave) + "sine_Nm[0]"); ++wave) {
    const std::string key = cogging_key(wave);
    found.waves.push_back({value(key + "wavelength_rad"), value(key + "sine_Nm"), value(key + "cosine_Nm")});
  }
  return found;
}

/// A robot drawn from a seed, in shipped scenarios; what is calibrated of it is taken over by all that is
/// read afterwards, as `calibrations` of the scenario. The texts `from` in scenarios are replaced by their
/// `to`.
class CalibratedRobot {
 public:
  using Replacements = std::vector<std::pair<std::string, std::string>>;

  explicit CalibratedRobot(std::uint64_t seed) : seed_(seed) {}

  SimulatedScenario scenario(const std::string& name, const Replacements& replacements = {}) const {
    const Workplace place;
    std::string list;
    for (std::size_t i = 0; i < files_.size(); ++i) {
      const std::string file = "found" + std::to_string(i) + ".yaml";
      place.write("scenarios/" + file, files_[i]);
      list += (i > 0 ? ", {file: " : "{file: ") + file + "}";
    }
    for (const auto& [from, to] : replacements) place.replace("scenarios/" + name, from, to);
    if (!list.empty())
      place.replace("scenarios/" + name, "\nseed: ", "\ncalibrations: [" + list + "]\nseed: ");
    return read_simulated_scenario(place / ("scenarios/" + name), seed_);
  }
  Simulated recorded(const std::string& name, const Replacements& replacements = {}) const {
    Simulated run{scenario(name, replacements), {}};
    run.recording = run_experiment(run.scenario);
    return run;
  }
  Verdict judged(const std::string& name, const Replacements& replacements = {}) const {
    return judge_experiment(scenario(name, replacements));
  }

  CalibrationResult torque_constants(const std::string& pulls, const Replacements& replacements = {}) {
    const Simulated run = recorded(pulls, replacements);
    const TorqueConstantBelief belief{.robot = run.scenario.robot.robot.get(),
                                      .drives = run.scenario.robot.drives,
                                      .constant = run.scenario.control.drive_torque.torque_constant};
    return keep(
        calibrate_torque_constants(belief, {{{pulls, ""}, &run.recording, run.scenario.mountings}}, {}),
        run.scenario);
  }
  CalibrationResult dynamics(const std::string& excitation, const Replacements& replacements = {}) {
    const Simulated run = recorded(excitation, replacements);
    const DynamicsBelief belief{.robot = run.scenario.robot.robot.get(),
                                .drives = run.scenario.robot.drives,
                                .constant = run.scenario.control.drive_torque.torque_constant};
    return keep(calibrate_dynamics(belief, {{{excitation, ""}, &run.recording}}, {}), run.scenario);
  }

 private:
  CalibrationResult keep(CalibrationResult result, const Scenario& scenario) {
    result.robot_file = scenario.robot_file.string();
    result.robot_sha256 = calibrated_robot_hash(scenario.robot_text);
    for (CalibrationSource& source : result.recordings) source.sha256 = std::string(64, '0');
    files_.push_back(calibration_yaml(result, "2026-01-01"));
    return result;
  }

  std::uint64_t seed_;
  std::vector<std::string> files_;
};

}  // namespace flinch::test
