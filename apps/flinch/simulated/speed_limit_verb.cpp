// flinch speed-limit: how fast a robot may move so that contacts stay within force limits.
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/flinch/printing.h"
#include "apps/flinch/shell_word.h"
#include "apps/flinch/shipped_files.h"
#include "apps/flinch/simulated/told_campaign.h"
#include "apps/flinch/stop_watch.h"
#include "experiments/report/run_folder.h"
#include "experiments/speed_limit/speed_limit_output.h"
#include "experiments/speed_limit/speed_limit_page.h"
#include "experiments/speed_limit/speed_limit_study.h"
#include "systems/config/parsed.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// "X,Y" in m.
Eigen::Vector2d place_of(const std::string& text) {
  Eigen::Vector2d place;
  const std::size_t comma = text.find(',');
  const auto number = [](const std::string& part, double& value) {
    const auto [rest, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc{} && rest == part.data() + part.size() && std::abs(value) <= 100.0;
  };
  if (comma == std::string::npos || !number(text.substr(0, comma), place.x()) ||
      !number(text.substr(comma + 1), place.y())) {
    throw SetupError("--at " + text + ": is no place; give x and y in m, such as --at -0.04,0");
  }
  return place;
}

std::vector<double> directions_of(const SpeedLimitOptions& options) {
  if (!options.towards.empty()) return options.towards;
  std::vector<double> directions;
  for (int i = 0; i < options.directions; ++i) directions.push_back(360.0 * i / options.directions);
  return directions;
}

SpeedLimitSettings settings_of(const SpeedLimitOptions& options) {
  SpeedLimitSettings settings{.scenario = or_shipped(options.scenario, "scenarios"),
                              .set = options.set,
                              .region = options.region,
                              .bodies = options.bodies,
                              .places = {},
                              .grid = options.grid,
                              .height = options.height,
                              .directions_deg = directions_of(options),
                              .share = options.share,
                              .confidence = options.confidence,
                              .runs = options.runs,
                              .slowest = options.slowest,
                              .fastest = options.fastest,
                              .step = options.step,
                              .seed = options.seed};
  for (const std::string& text : options.places) settings.places.push_back(place_of(text));
  return settings;
}

/// The command that repeats the nearest run of a limit.
LimitCall call_of_runs(const SpeedLimitOptions& options, const SpeedLimitStudy& study) {
  return [&options, &study](const SpeedLimit& limit) {
    std::string call = "flinch run " + shell_word(options.scenario.string()) + " --seed " +
                       std::to_string(limit.nearest.seed);
    for (const auto& [key, value] : values_of_run(study, limit))
      call += " --set " + shell_word(key + "=" + value);
    for (const std::string& text : options.set) call += " --set " + shell_word(text);
    return call;
  };
}

RunFolder folder_of(const SpeedLimitOptions& options, const Campaign& campaign) {
  RunFolder folder = make_run_folder(options.out.empty() ? default_folder(campaign.name) : options.out);
  if (options.fresh) std::filesystem::remove(folder.path / "results.part");
  return folder;
}

}  // namespace

ExitStatus speed_limit(const SpeedLimitOptions& options) {
  const SpeedLimitStudy study = read_speed_limit_study(settings_of(options));
  const std::unique_ptr<CampaignHelpers> helpers = helpers_of(study.campaign);
  if (helpers && !helpers->leads()) {
    helpers->work(study.campaign);
    return ExitStatus::done;
  }
  const RunFolder folder = folder_of(options, study.campaign);
  const StopWatch watch;
  const CampaignResults results =
      run_told(study.campaign, "speed limits of " + options.scenario.stem().string(), folder.path,
               options.threads.value_or(helpers ? 1 : 0), options.common, helpers.get())
          .results;
  const std::vector<SpeedLimit> limits = speed_limits_of(study, results);
  const std::string json = speed_limit_json(study, limits) + "\n";
  print_result("{}", options.common.json ? json : speed_limit_table(study, limits));
  flush_results();  // before what stderr says, where both go into one file
  const std::filesystem::path page = folder.path / "speed_limit.html";
  write_result(page,
               speed_limit_page(study, limits, call_of_runs(options, study), options.common.command_line));
  write_result(folder.path / "speed_limit.json", json);
  if (!options.common.quiet) {
    print_message("{} cells in {:.1f} s\nresults:   {}, speed_limit.json\nreport:    {}\n", limits.size(),
                  watch.seconds(), (folder.path / "results.csv").string(), page.string());
  }
  return ExitStatus::done;
}

}  // namespace flinch
