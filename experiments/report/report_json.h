#pragma once

#include <nlohmann/json_fwd.hpp>

#include "experiments/report/report.h"

namespace flinch {

/// The data object of the report page, as report/README.md describes it. Numbers are rounded to six
/// significant digits; what is not finite is null. The report must have passed `check_report()`.
nlohmann::json report_json(const Report& report);

}  // namespace flinch
