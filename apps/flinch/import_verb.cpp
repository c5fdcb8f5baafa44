// flinch import: a recording out of a log of another tool.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "apps/flinch/command_line.h"
#include "calibration/csv_recording.h"

namespace flinch {

ExitStatus import_log(const ImportOptions& options) {
  const Recording recording =
      read_csv_recording(options.mapping, {{"command_line", options.common.command_line}});
  write_recording(recording, options.out);
  const double seconds = to_seconds(recording.period) * static_cast<double>(recording.samples());
  if (options.common.json) {
    fmt::print(
        "{}\n",
        nlohmann::ordered_json{{"recording", options.out.string()}, {"samples", recording.samples()}}.dump());
  } else if (!options.common.quiet) {
    fmt::print("recording: {}, {:.1f} s\n", options.out.string(), seconds);
  }
  return ExitStatus::done;
}

}  // namespace flinch
