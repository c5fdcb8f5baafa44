// flinch run: one experiment, with whatever stands for the robot.
#include <fmt/core.h>

#include <chrono>

#include "apps/flinch/command_line.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/run_folder.h"
#include "experiments/recorded/replay.h"
#include "experiments/scenario/scenario.h"
#include "experiments/simulated/experiment.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"
#if FLINCH_HAS_BUS
#include "apps/flinch/bus/bus_verbs.h"
#endif

namespace flinch {
namespace {

/// Time since it was made [s].
class StopWatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  }

 private:
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

bool is_silent(const CommonOptions& common) { return common.quiet || common.json; }

ExitStatus run_simulated(const RunOptions& options) {
  const Scenario scenario = read_scenario(options.input, options.seed);
  out_of(scenario.file, [&] { return build_experiment(scenario); });  // before anything is written
  const std::filesystem::path folder = make_run_folder(options, scenario.name);
  const StopWatch watch;
  Recording recording;
  {
    Progress progress("simulating " + scenario.name, is_silent(options.common));
    recording = run_experiment(scenario, {{"command_line", options.common.command_line}},
                               [&progress](double share) { progress.show(share); });
  }
  return conclude_run(scenario, recording, watch.seconds(), folder, options.common);
}

void tell_what_differs(const Replay& replayed, const CommonOptions& common) {
  if (common.quiet) return;
  if (replayed.differing.empty()) {
    fmt::print(stderr, "replay:    every signal is the same as before, bit for bit\n");
    return;
  }
  std::string list;
  for (const std::string& path : replayed.differing) list += (list.empty() ? "" : ", ") + path;
  fmt::print(stderr, "replay:    differs from the recording in: {}\n", list);
}

ExitStatus run_recorded(const RunOptions& options) {
  const Recording recorded = read_recording(options.input);
  const Scenario scenario =
      options.control.empty() ? recorded_scenario(recorded, options.input) : read_scenario(options.control);
  const StopWatch watch;
  Replay replayed;
  {
    Progress progress("replaying " + scenario.name, is_silent(options.common));
    replayed = out_of(options.input, [&] {
      return replay(scenario, recorded, {{"command_line", options.common.command_line}},
                    [&progress](double share) { progress.show(share); });
    });
  }
  const std::filesystem::path folder = make_run_folder(options, scenario.name + "_replayed");
  std::error_code no_such_file;
  if (std::filesystem::equivalent(folder / "run.h5", options.input, no_such_file)) {
    throw SetupError(options.input.string() +
                     ": the replay would replace it; choose another folder with --out");
  }
  tell_what_differs(replayed, options.common);
  return conclude_run(scenario, replayed.recording, watch.seconds(), folder, options.common);
}

ExitStatus run_on_dds(const RunOptions& options) {
#if FLINCH_HAS_BUS
  return run_on_bus(options);
#else
  throw SetupError("--station dds: " + options.input.string() +
                   " cannot be run on the bus, for this flinch was built without Cyclone DDS");
#endif
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
  const bool names_a_bus = options.bus != BusOptions() || options.reset_faults;
  if (names_a_bus && options.station != StationKind::dds) {
    problems.push_back("the options of the bus mean something only with --station dds");
  }
  throw_if_any(std::move(problems));
}

}  // namespace

ExitStatus run(const RunOptions& options) {
  check(options);
  switch (options.station) {
    case StationKind::recorded:
      return run_recorded(options);
    case StationKind::dds:
      return run_on_dds(options);
    case StationKind::simulated:
      break;
  }
  return run_simulated(options);
}

}  // namespace flinch
