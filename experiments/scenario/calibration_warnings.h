#pragma once

#include <string>
#include <vector>

namespace flinch {

struct Scenario;

/// Something doubtful about the calibrations of a scenario.
struct CalibrationWarning {
  std::string sentence;
  /// Of a threshold of the scenario that does not count beside those of estimators, without its unit; empty
  /// where the doubt is about a calibration.
  std::string key = {};

  bool operator==(const CalibrationWarning&) const = default;
};

/// All of a scenario that has been read: calibrations of another robot file; resting on torque constants or
/// settings of estimators that are no longer used; one replacing another; thresholds of the scenario that do
/// not count.
std::vector<CalibrationWarning> warnings_about_calibrations(const Scenario& scenario);

}  // namespace flinch
