// flinch export: a recording, or a robot, for other tools.
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/flinch/command_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "convert/legs_of_robot.h"
#include "convert/mjcf_text.h"
#include "convert/urdf_text.h"
#include "export/csv_folder.h"
#include "export/exported_signal.h"
#include "export/mat_file.h"
#include "export/mcap_file.h"
#include "export/npz_file.h"
#include "systems/config/config_file.h"
#include "systems/config/file_kind.h"
#include "systems/config/robot_file.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

using Write = void (*)(const Recording&, const std::vector<ExportedSignal>&, const std::filesystem::path&);

Write writer_of(const std::string& format) {
  static const std::map<std::string, Write> writers = {
      {"csv", write_csv_folder}, {"mat", write_mat}, {"mcap", write_mcap}, {"npz", write_npz}};
  return writers.at(format);
}

/// run.h5 gives run.npz, or the folder run_csv.
std::filesystem::path place_of(const ExportOptions& options) {
  if (!options.out.empty()) return options.out;
  std::filesystem::path place = options.recording;
  if (place.extension() == ".part") place.replace_extension();
  place.replace_extension();
  place += options.format == "csv" ? "_csv" : "." + options.format;
  return place;
}

/// Throws SetupError where a file would get a name that another kind has, or replace the recording.
void require_place_for(const ExportOptions& options, const std::filesystem::path& place) {
  if (options.format == "csv") {
    if (std::filesystem::exists(place) && !std::filesystem::is_directory(place))
      throw SetupError(place.string() + ": is a file; a folder is needed for a table of each signal");
    return;
  }
  if (place.extension() != "." + options.format && !std::filesystem::is_character_file(place))
    throw SetupError(place.string() + ": the name must end in '." + options.format + "'");
  require_place(place, {options.recording});
}

std::vector<std::string> each_once(const std::vector<std::string>& names) {
  std::vector<std::string> once;
  for (const std::string& name : names) {
    if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
  }
  return once;
}

/// ROBOT.urdf, and beside it what closes its loops.
std::filesystem::path closures_beside(const std::filesystem::path& model) {
  return model.parent_path() / (model.stem().string() + "_closures.yaml");
}

/// A robot as a model.
ExitStatus export_robot(const ExportOptions& options) {
  const bool is_urdf = options.format == "urdf";
  std::filesystem::path place = options.out;
  if (place.empty())
    place = std::filesystem::path(options.recording).replace_extension(is_urdf ? ".urdf" : ".xml");
  const std::filesystem::path closures = closures_beside(place);
  if (!options.signals.empty())
    throw SetupError("--signal: is for recordings, and " + options.format + " is for robots");
  require_output(place, {options.recording}, is_urdf ? OutputKind::urdf : OutputKind::model);
  if (is_urdf) require_output(closures, {options.recording}, OutputKind::closures);
  const RobotFile file = read_robot_file(options.recording);  // which names the file in its errors
  const UrdfTexts texts = out_of(options.recording, [&]() -> UrdfTexts {
    const LegsParameters robot = as_legs(*file.robot, read_config_file(options.recording), options.recording);
    if (is_urdf) return urdf_texts(robot, file.drives.max_torque);
    return {mjcf_text(robot), ""};
  });
  write_result(place, texts.model);
  if (is_urdf) write_result(closures, texts.closures);
  if (options.common.json) {
    nlohmann::ordered_json told{{"to", options.format}, {"out", place.string()}};
    if (is_urdf) told["closures"] = closures.string();
    print_result("{}\n", json_text(told));
  } else if (!options.common.quiet) {
    print_result("{}: a model {}\n", place.string(), is_urdf ? "as URDF" : "for MuJoCo");
    if (is_urdf) print_result("{}: what closes its loops\n", closures.string());
  }
  return ExitStatus::done;
}

}  // namespace

ExitStatus export_recording(const ExportOptions& options) {
  if (options.format == "mjcf" || options.format == "urdf") return export_robot(options);
  require_no_kind(options.recording, "a recording");
  const Recording recording = open_recording(options.recording);
  tell_if_partial(recording, options.common);
  const std::filesystem::path place = place_of(options);
  require_place_for(options, place);
  std::size_t columns = 0;
  const std::vector<ExportedSignal> signals =
      out_of(options.recording, [&] { return exported_signals(recording, each_once(options.signals)); });
  writer_of(options.format)(recording, signals, place);
  for (const ExportedSignal& signal : signals) {
    for (const ExportedField& field : signal.fields) columns += field.width();
  }
  if (options.common.json) {
    print_result("{}\n", json_text(nlohmann::ordered_json{{"to", options.format},
                                                          {"out", place.string()},
                                                          {"signals", signals.size()},
                                                          {"columns", columns},
                                                          {"samples", recording.samples()}}));
  } else if (!options.common.quiet) {
    print_result("{}: {} signals, {} columns, {} samples\n", place.string(), signals.size(), columns,
                 recording.samples());
  }
  return ExitStatus::done;
}

}  // namespace flinch
