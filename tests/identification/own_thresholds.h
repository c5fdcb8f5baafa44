#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "calibration/contact_free_motion.h"
#include "calibration/contact_free_peaks.h"
#include "calibration/drive_deviations.h"
#include "calibration/residual_calibration.h"
#include "calibration/threshold_calibration.h"
#include "diagrams/contact_control_settings.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/perturbed_robot.h"

namespace flinch::test {

/// By what a robot tells contacts.
struct OwnThresholds {
  std::map<std::string, OwnThreshold> plain;  ///< by estimator
  std::vector<FusedResidual> residuals;       ///< of the fused detector
  JointVector drive_deviations;               ///< of the wrench by which it tells what was touched [Nm or N]

  void give(ContactControlSettings& control) const {
    control.reaction_thresholds = plain;
    control.fused_detector.residuals = residuals;
    control.isolation.uncertainty.drive_torque = drive_deviations;
  }
};

/// A robot in motion without contact, with what its controller knows of it.
struct FreeMotion {
  SimulatedScenario scenario;
  Recording recording;  ///< signals that tell thresholds
};

inline FreeMotion free_motion(SimulatedScenario scenario) {
  FreeMotion made{std::move(scenario), {}};
  made.recording =
      run_for_signals(made.scenario, {"detection", "reaction", "wrench", "reference", "gate", "contact",
                                      "truth", "wrench_disturbance_filter", "wrench_imu_residual",
                                      "load_fused_detector", isolation_signal});
  made.recording.attributes["control.estimator"] = followed_name(made.scenario.control.stages.estimators);
  return made;
}

inline OwnThresholds thresholds_of(const std::vector<const FreeMotion*>& robots, const ThresholdGoal& goal) {
  std::vector<std::vector<EstimatorPeaks>> peaks;
  std::vector<ResidualRecording> recordings;
  for (const FreeMotion* const robot : robots) {
    const ConfigurationSpace space = robot->scenario.robot.robot->space();
    peaks.push_back(contact_free_peaks(robot->recording, space, goal.stretch));
    recordings.emplace_back(robot->recording, nominal_samples(robot->recording, space),
                            robot->scenario.control);
  }
  OwnThresholds found;
  for (const EstimatorThresholds& of : calibrate_thresholds(pooled(peaks), goal))
    found.plain[of.estimator] = {of.force.value, of.moment.value};
  for (const CalibratedResidual& of : calibrate_residuals(recordings, goal)) {
    found.residuals.push_back(
        {.estimator = of.estimator,
         .level = {of.level.threshold.value, of.level.errors},
         .change = {of.change.threshold.value, of.change.errors},
         .smoothed = MahalanobisThreshold{of.smoothed.threshold.value, of.smoothed.errors}});
  }
  found.drive_deviations =
      drive_deviations(recordings, *robots.front()->scenario.robot.robot, IsolationSettings().uncertainty);
  return found;
}

/// Puts a robot in the place of that of a scenario that is as its model, with what its controller knows.
inline void put(const SimulatedScenario& robot, SimulatedScenario& scenario) {
  scenario.perturbed_robot = robot.perturbed_robot;
  scenario.station = with_perturbed_robot(std::move(scenario.station), robot.perturbed_robot);
  scenario.robot = robot.robot;
  scenario.calibrations = robot.calibrations;
  scenario.control.drive_torque = robot.control.drive_torque;
}

}  // namespace flinch::test
