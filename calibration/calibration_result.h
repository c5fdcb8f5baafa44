#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "systems/config/parameter_file.h"

namespace flinch {

/// Where a calibration comes from.
using CalibrationSource = HashedFile;

/// What was found for one number.
struct CalibratedParameter {
  std::string name{};  ///< Where it belongs to a file, the path of its key there: "drives.max_torque_Nm".
  double value = 0.0;
  std::optional<double> deviation{};  ///< Standard deviation; none: the data say nothing of it.
  std::string unit{};                 ///< SI
  bool identifiable = true;           ///< Otherwise `value` is what was believed before.
  std::optional<double> before{};     ///< What was believed.
  std::string belongs_to{};           ///< "robot" or "scenario" file; empty: to none, it is only told.
};

/// Five numbers of a sample, as a box plot shows them.
struct BoxNumbers {
  std::string name;
  double low = 0.0, quartile1 = 0.0, median = 0.0, quartile3 = 0.0, high = 0.0;
};

/// Points of one quantity over another, before and after.
struct CalibrationPlot {
  std::string title;
  std::string x_name, x_unit, y_name, y_unit;
  std::vector<double> x, before, after;
};

/// What a calibration found, why to believe it, and what is wrong with what it was given.
struct CalibrationResult {
  std::string kind;  ///< "torque-constant"
  std::string robot_file;
  std::string robot_sha256;  ///< Of the robot file that the recordings keep.
  std::vector<CalibrationSource> recordings;
  std::vector<CalibrationSource> unseen;  ///< Recordings that were not used, for `validation`.
  std::vector<CalibrationSource> with;    ///< Parameter files that these rest on.
  std::vector<CalibratedParameter> parameters;
  double residual_before = 0.0;  ///< Root mean square, with what was believed.
  double residual_after = 0.0;
  std::string residual_unit;
  std::vector<CalibratedParameter> assumed;  ///< What these rest on: torque constants.
  int rank = 0;
  double condition = 0.0;
  std::vector<std::string> notes;     ///< What is good to know, one sentence each.
  std::vector<std::string> warnings;  ///< What is wrong and what to do about it, one sentence each.
  /// Why what it was given cannot be right, with the likely cause, one sentence each. Nothing of it should be
  /// used then.
  std::vector<std::string> contradictions;

  Eigen::MatrixXd covariance;  ///< Of the parameters, in their order.
  Eigen::MatrixXd influence;   ///< How each parameter changes where each recording is left out; or empty.
  std::vector<CalibrationPlot> plots;
  std::string validation_unit;
  std::vector<BoxNumbers> validation;  ///< Errors on recordings that were not used.
};

/// A unit as it stands behind a number: " Nm", and nothing for what has none, "1".
inline std::string behind_number(const std::string& unit) { return unit == "1" ? "" : " " + unit; }

/// The same of a residual, which without a unit is relative, [RAL25] (10).
inline std::string behind_residual(const std::string& unit) {
  return unit == "1" ? " of the largest reading" : " " + unit;
}

}  // namespace flinch
