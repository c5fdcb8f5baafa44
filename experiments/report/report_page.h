#pragma once

#include <filesystem>
#include <string>

#include "experiments/report/report.h"

namespace flinch {

/// The report as one HTML page that needs nothing else: no network, no other file.
/// Numbers are rounded to six significant digits; what is not finite becomes "no data".
/// Throws as `check_report()` does.
std::string report_page(const Report& report);

/// Writes `report_page(report)` to `path`. Throws SetupError if that fails.
void write_report_page(const Report& report, const std::filesystem::path& path);

}  // namespace flinch
