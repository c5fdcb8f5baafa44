#pragma once

#include <string>

namespace flinch {

struct CalibrationResult;

/// The result as one HTML page that needs nothing else and runs no script: parameters with their deviations,
/// residuals before and after, error ellipses, influence of each recording, errors on recordings that were
/// not used.
std::string calibration_page(const CalibrationResult& result, const std::string& date);

}  // namespace flinch
