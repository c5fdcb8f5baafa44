// flinch run: one experiment, with whatever stands for the robot.
#include "apps/flinch/bus/bus_verbs.h"
#include "apps/flinch/command_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/fault_options.h"
#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/shipped_files.h"
#include "apps/flinch/simulated/simulated_parts.h"
#include "apps/flinch/stop_watch.h"
#include "experiments/recorded/replay.h"
#include "experiments/report/run_folder.h"
#include "systems/config/file_kind.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

void tell_what_differs(const Replay& replayed, const CommonOptions& common) {
  if (common.quiet) return;
  if (replayed.differing.empty()) {
    print_message("replay:    every signal is the same as before, bit for bit\n");
    return;
  }
  std::string list;
  for (const std::string& path : replayed.differing) list += (list.empty() ? "" : ", ") + path;
  print_message("replay:    differs from the recording in: {}\n", list);
}

std::vector<std::string> body_names(const Scenario& scenario) {
  std::vector<std::string> names;
  for (const Body& body : scenario.robot.robot->description().bodies) names.push_back(body.name);
  return names;
}

/// The scenario whose control path shall run: that of the recording, or another one for such a robot.
Scenario scenario_to_replay(const Recording& recorded, const RunOptions& options) {
  Scenario of_recording = scenario_of(recorded, options.input);
  if (options.control.empty()) return of_recording;
  Scenario scenario = scenario_of(recorded, options.input, options.control);
  if (body_names(scenario) == body_names(of_recording)) return scenario;
  throw SetupError(options.control.string() + ": is for the robot '" + scenario.robot.robot->name() +
                   "', but " + options.input.string() + " was recorded of '" +
                   of_recording.robot.robot->name() + "', which has other bodies");
}

ExitStatus run_recorded(const RunOptions& options) {
  require_no_kind(options.input, "a recording");
  const Recording recorded = read_recording(options.input);
  tell_if_partial(recorded, options.common);
  Scenario scenario = scenario_to_replay(recorded, options);
  require_run(recorded, options.input);
  if (!options.classifier.empty()) classifier_of(options.classifier)(scenario);
  std::vector<RequestedFault> faults;
  add_faults(options.faults, *scenario.robot.robot, faults);
  const StopWatch watch;
  Replay replayed;
  {
    Progress progress("replaying " + scenario.name, options.common.quiet || options.common.json);
    replayed = out_of(options.input, [&] {
      return replay(
          scenario, recorded, {{"command_line", options.common.command_line}},
          [&progress](double share) { progress.show(share); }, faults);
    });
  }
  const RunFolder folder = folder_of(options, scenario.name + "_replayed");
  std::error_code no_such_file;
  if (std::filesystem::equivalent(recording_in(folder), options.input, no_such_file)) {
    throw SetupError(options.input.string() +
                     ": the replay would replace it; choose another folder with --out");
  }
  tell_what_differs(replayed, options.common);
  write_recording(replayed.recording, recording_in(folder));
  return conclude(scenario, watch.seconds(), folder, options.common);
}

/// Says which options mean nothing for this station.
void check(const RunOptions& options) {
  std::vector<std::string> problems;
  if (!options.control.empty() && options.station != StationKind::recorded) {
    problems.push_back("--control: only a recording can be given another control, with --station recorded");
  }
  if (options.seed && options.station != StationKind::simulated) {
    problems.push_back("--seed: only a simulated station has noise that could be drawn anew");
  }
  if (!options.set.empty() && options.station == StationKind::recorded) {
    problems.push_back(
        "--set: the scenario of a recording stays as it was; write its 'scenario.text' to a file, change it "
        "there and give it with --control");
  }
  if (!options.faults.empty() && options.station == StationKind::dds) {
    problems.push_back(
        "--fault: a robot on the bus has its own faults; 'flinch serve' makes them for one that is "
        "simulated");
  }
  if (options.names_a_bus && options.station != StationKind::dds) {
    problems.push_back("the options of the bus mean something only with --station dds");
  }
  if (options.live.asked() && options.station == StationKind::recorded) {
    problems.push_back("--live: a recording is over; 'flinch report' shows it");
  }
  if (options.live.waits && !options.live.asked()) {
    problems.push_back("--live-wait: means something only with --live");
  }
  if (options.live.sets_speed && (!options.live.asked() || options.station != StationKind::simulated)) {
    problems.push_back("--live-speed: means something only with --live and a simulated station");
  }
  throw_if_any(std::move(problems));
}

}  // namespace

ExitStatus run(const RunOptions& given) {
  check(given);
  if (given.station == StationKind::recorded) return run_recorded(given);
  RunOptions options = given;
  options.input = or_shipped(given.input, "scenarios");
  switch (options.station) {
    case StationKind::dds:
      return run_on_bus(options);
    case StationKind::recorded:
    case StationKind::simulated:
      break;
  }
  return run_simulated(options);
}

}  // namespace flinch
