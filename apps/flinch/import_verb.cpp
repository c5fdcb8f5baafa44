// flinch import: a recording out of a log of another tool.
#include <nlohmann/json.hpp>

#include "apps/flinch/command_line.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "calibration/csv_recording.h"
#include "systems/foundation/json_text.h"

namespace flinch {

ExitStatus import_log(const ImportOptions& options) {
  require_output(options.out, files_of_mapping(options.mapping), OutputKind::recording);
  const Recording recording =
      read_csv_recording(options.mapping, {{"command_line", options.common.command_line}});
  write_recording(recording, options.out);
  const double seconds = to_seconds(recording.period) * static_cast<double>(recording.samples());
  if (options.common.json) {
    print_result("{}\n", json_text(nlohmann::ordered_json{{"recording", options.out.string()},
                                                          {"samples", recording.samples()}}));
  } else if (!options.common.quiet) {
    print_result("recording: {}, {:.1f} s\n", options.out.string(), seconds);
  }
  return ExitStatus::done;
}

}  // namespace flinch
