#pragma once

#include <string>
#include <vector>

#include "calibration/calibration_result.h"
#include "calibration/residual_calibration.h"

namespace flinch {

struct Scenario;

/// What was found for a rate of false alarms.
struct ThresholdFindings {
  ThresholdGoal goal{};
  std::vector<EstimatorThresholds> estimators{};
  std::vector<CalibratedResidual> residuals{};  ///< empty: no fused detector told the loads of the drives
  std::vector<CalibrationSource> recordings{};  ///< that they come from
  HashedFile robot{};                           ///< of all of them; no hash: they are of several
  std::vector<FileParameter> assumed{};         ///< torque constants of all of them; none: they differ
  std::vector<ReadValue> settings{};            ///< of the estimators, in all of them
  std::vector<CalibrationSource> with{};        ///< parameter files with which these were played again
  ConfigurationSpace space = ConfigurationSpace::Kind::planar_pose;  ///< of the robot
  ResidualTracking tracking{};  ///< with which the fused detector must follow its residuals
  bool drives_turn = true;
  std::vector<std::string> warnings{};  ///< about single recordings, one sentence each
  /// Of what the classifiers and locators read, at each drive; empty: not recorded [Nm or N]
  JointVector drive_deviations{};
};

/// Notes of which robot, and with which torque constants, all recordings of these scenarios were made.
void note_robot(const std::vector<Scenario>& scenarios, ThresholdFindings& found);

/// Notes with which settings of their estimators the recordings of these scenarios, which are
/// `found.recordings`, were made. Throws SetupError where they differ: thresholds hold for one of them.
void note_settings(const std::vector<Scenario>& scenarios, ThresholdFindings& found);

/// What is wrong with the recordings and what to do about it, one sentence each.
std::vector<std::string> warnings(const ThresholdFindings& found);

/// Thresholds of force [N] and of moment [Nm], none for a robot that does not turn: one for all components,
/// or one of each where that was asked.
std::vector<double> force_values(const EstimatorThresholds& of, const ConfigurationSpace& space);
std::vector<double> moment_values(const EstimatorThresholds& of, const ConfigurationSpace& space);

/// As a table for people; as one JSON object on one line, to which later versions add keys and rename none;
/// and as a parameter file with the sections `contact_detector`, `fused_detector` and `isolation` of
/// `control`, as far as they are known, and with what they come from above: made on `date`, "2026-11-22".
std::string thresholds_table(const ThresholdFindings& found);
std::string thresholds_json(const ThresholdFindings& found);
std::string thresholds_yaml(const ThresholdFindings& found, const std::string& date);

}  // namespace flinch
