#pragma once

#include <string>

namespace flinch {

struct CalibrationResult;

/// As a table for people; as one JSON object on one line, to which later versions add keys and rename none.
std::string calibration_table(const CalibrationResult& result);
std::string calibration_json(const CalibrationResult& result);
/// As a parameter file, which says that it was made on `date`: "2026-11-22".
std::string calibration_yaml(const CalibrationResult& result, const std::string& date);

}  // namespace flinch
