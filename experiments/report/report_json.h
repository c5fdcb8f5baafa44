#pragma once

#include <string>

#include "experiments/report/report.h"

namespace flinch {

/// The data object of the report page, as report/README.md describes it. Numbers are rounded to six
/// significant digits; what is not finite is null; bytes that are not UTF-8 become the replacement character.
/// The report must have passed `check_report()`.
std::string report_json(const Report& report);

/// The columns and lanes of such an object alone, without braces about them: `"columns": {...}, "lanes":
/// [...]`.
std::string samples_json(const Report& report);

}  // namespace flinch
