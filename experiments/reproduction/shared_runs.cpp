#include "experiments/reproduction/shared_runs.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <future>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_summary.h"
#include "experiments/campaign/reaction_summary.h"
#include "experiments/campaign/run_campaign.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/reproduction/figure_path.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "experiments/verdict/verdict_output.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

/// What is run, and what it says.
struct SharedRuns::Run {
  RunSource source;
  std::optional<SimulatedScenario> scenario;
  std::set<std::string> signals;  ///< of which curves are made
  std::optional<Campaign> campaign;
  nlohmann::json said;
  std::optional<Recording> recording;  ///< of the signals
  std::optional<CampaignResults> results;
  double wall = 0.0;

  double size() const {
    if (campaign) return static_cast<double>(campaign->runs());
    return scenario ? 1.0 : 100.0 * static_cast<double>(source.commands.size());
  }
};

namespace {

using WallClock = std::chrono::steady_clock;

double seconds_since(WallClock::time_point start) {
  return std::chrono::duration<double>(WallClock::now() - start).count();
}

[[noreturn]] void stopped() {
  throw SetupError("stopped before all was run; the same command goes on with what its campaigns have done");
}

nlohmann::json said_by(const Campaign& campaign, const CampaignResults& results) {
  const std::string text = campaign.summary == Campaign::Summary::reactions
                               ? reactions_json(campaign, reactions_of(results, campaign.missed_after), {})
                               : campaign_json(campaign, results, groups_of(campaign, results), {});
  return nlohmann::json::parse(text);
}

/// When the first contact of a run began [s].
std::optional<double> contact_of(const nlohmann::json& said) {
  return figure_at(said, "contacts[0].onset_s");
}

/// A curve of a run, as it is counted from there.
CurveSamples samples_of(const SignalCurve& curve, const Recording& recording, const nlohmann::json& said) {
  return sampled(curve, recording, contact_of(said)).value_or(CurveSamples{});
}

/// The number in a column of a row; none where nothing stands there.
std::optional<double> cell(const std::vector<std::string>& names, const std::vector<std::string>& cells,
                           const std::string& name) {
  const auto place = std::find(names.begin(), names.end(), name);
  if (place == names.end())
    throw SetupError("a picture asks for the column '" + name + "', which the campaign's table has not" +
                     did_you_mean(name, names));
  const std::string& text = cells.at(static_cast<std::size_t>(place - names.begin()));
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// What is wrong with the names of the signals that are asked of a scenario's run.
void check_signals(const SimulatedScenario& scenario, const std::set<std::string>& signals,
                   std::vector<std::string>& problems) {
  if (signals.empty()) return;
  const std::vector<std::string> known = recorded_paths(*build_experiment(scenario).diagram);
  for (const std::string& name : signals) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      problems.push_back("runs of " + scenario.file.string() + " record no signal '" + name + "'" +
                         did_you_mean(name, known));
  }
}

}  // namespace

SharedRuns::SharedRuns(const PaperFigures& wanted) : wanted_(wanted) {
  std::vector<std::string> problems;
  const auto need = [&](const RunSource& source, const std::vector<std::string>& signals) {
    auto same =
        std::find_if(runs_.begin(), runs_.end(), [&](const auto& run) { return run->source == source; });
    if (same == runs_.end()) {
      Run& run = *runs_.emplace_back(std::make_unique<Run>());
      run.source = source;
      try {
        if (source.kind == RunSource::Kind::campaign)
          run.campaign = read_campaign(source.file, {.set = source.set, .draws = source.runs});
        if (source.kind == RunSource::Kind::scenario)
          run.scenario = read_simulated_scenario(source.file, source.set);
      } catch (const SetupError& error) {
        problems.insert(problems.end(), error.problems().begin(), error.problems().end());
      }
      same = runs_.end() - 1;
    }
    (*same)->signals.insert(signals.begin(), signals.end());
  };
  const auto need_curve = [&](const RunSource& source, const std::optional<SignalCurve>& curve) {
    if (curve) need(source, curve->signals());
  };
  for (const PaperFigure& figure : wanted.figures) {
    for (const auto* source : {&figure.as_printed, &figure.ours}) {
      if (!*source) continue;
      need((*source)->run, {});
      need_curve((*source)->run, (*source)->curve);
      need_curve((*source)->run, (*source)->statistic.other);
    }
  }
  for (const PaperPicture& picture : wanted.pictures) {
    for (const PictureLine& line : picture.lines) {
      need_curve(line.run, line.curve);
      need_curve(line.run, line.over);
    }
    for (const PictureDots& dots : picture.dots) need(dots.run, {});
    if (picture.matrix) need(picture.matrix->run, {});
  }
  throw_if_any(std::move(problems));
  std::vector<std::string> unknown;
  for (const auto& run : runs_)
    if (run->scenario) check_signals(*run->scenario, run->signals, unknown);
  throw_if_any(std::move(unknown));
}

SharedRuns::~SharedRuns() = default;

SharedRuns::Run& SharedRuns::of(const RunSource& source) const {
  return **std::find_if(runs_.begin(), runs_.end(), [&](const auto& run) { return run->source == source; });
}

bool SharedRuns::show(const ReproductionOptions& options, double more) const {
  double all = 0.0;
  for (const auto& run : runs_) all += run->size();
  return !options.progress || options.progress((done_ + more) / std::max(1.0, all));
}

void SharedRuns::do_single_runs(const ReproductionOptions& options) {
  std::vector<Run*> single;
  for (const auto& run : runs_)
    if (run->scenario) single.push_back(run.get());
  std::atomic<std::size_t> next = 0, done = 0;
  std::atomic<bool> stop = false;
  const auto work = [&] {
    for (std::size_t i = next++; i < single.size() && !stop; i = next++) {
      Run& run = *single[i];
      const WallClock::time_point start = WallClock::now();
      run.said = nlohmann::json::parse(verdict_json(judge_experiment(*run.scenario), {}));
      run.wall = seconds_since(start);
      run.said["wall_s"] = run.wall;
      if (!run.signals.empty())
        run.recording = run_for_signals(*run.scenario, {run.signals.begin(), run.signals.end()});
      ++done;
    }
  };
  const std::size_t threads =
      options.threads > 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::future<void>> workers;
  for (std::size_t i = 0; i < std::min(threads, single.size()); ++i)
    workers.push_back(std::async(std::launch::async, work));
  for (std::future<void>& worker : workers) {
    while (worker.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready)
      if (!show(options, static_cast<double>(done))) stop = true;
  }
  for (std::future<void>& worker : workers) worker.get();
  if (stop) stopped();
  done_ += static_cast<double>(single.size());
}

void SharedRuns::do_campaign(Run& run, const ReproductionOptions& options) {
  // Its own name, and a number where it is not the first one of that name.
  const std::string& name = run.campaign->name;
  std::size_t number = 1;
  for (const auto& other : runs_) {
    if (other.get() == &run) break;
    if (other->campaign && other->campaign->name == name) ++number;
  }
  const std::filesystem::path folder =
      options.folder / (number == 1 ? name : name + "_" + std::to_string(number));
  const WallClock::time_point start = WallClock::now();
  bool goes_on = true;
  std::filesystem::create_directories(folder);
  run.results = run_campaign(*run.campaign, folder, options.threads, [&](std::size_t done, std::size_t) {
    return goes_on = show(options, static_cast<double>(done));
  });
  if (!goes_on) stopped();
  run.said = said_by(*run.campaign, *run.results);
  run.wall = seconds_since(start);
  done_ += run.size();
}

void SharedRuns::do_commands(Run& run, const ReproductionOptions& options) {
  if (!options.run_command) throw SetupError("figures of commands need the program 'flinch'");
  static_cast<void>(show(options));
  const WallClock::time_point start = WallClock::now();
  std::string printed;
  for (const std::vector<std::string>& words : run.source.commands) {
    // What an earlier figure has made for this call is there.
    const auto is_done = [&](const auto& other) {
      return other.get() != &run && !other->said.is_null() &&
             std::find(other->source.commands.begin(), other->source.commands.end(), words) !=
                 other->source.commands.end();
    };
    const bool is_last = &words == &run.source.commands.back();
    if (is_last || std::none_of(runs_.begin(), runs_.end(), is_done))
      printed = options.run_command(words, options.folder);
    if (!show(options)) stopped();
  }
  run.said = nlohmann::json::parse(printed, nullptr, false);
  if (run.said.is_discarded())
    throw SetupError("'flinch " + run.source.commands.back().front() + "' printed no JSON; write its --json");
  run.wall = seconds_since(start);
  done_ += run.size();
}

void SharedRuns::check_curves() const {
  for (const PaperFigure& figure : wanted_.figures)
    for (const auto* source : {&figure.as_printed, &figure.ours})
      if (*source && (*source)->curve) static_cast<void>(this->figure(**source));
  for (const PaperPicture& picture : wanted_.pictures)
    for (const PictureLine& each : picture.lines) static_cast<void>(line(each));
}

void SharedRuns::run(const ReproductionOptions& options) {
  do_single_runs(options);
  check_curves();  // before what takes longer
  for (const auto& run : runs_)
    if (run->campaign) do_campaign(*run, options);
  for (const auto& run : runs_)
    if (run->source.kind == RunSource::Kind::commands) do_commands(*run, options);
}

std::optional<double> SharedRuns::figure(const FigureSource& source) const {
  const Run& run = of(source.run);
  if (source.curve) {
    const CurveSamples curve = samples_of(*source.curve, *run.recording, run.said);
    const CurveSamples other = source.statistic.other
                                   ? samples_of(*source.statistic.other, *run.recording, run.said)
                                   : CurveSamples{};
    const std::optional<double> value = taken(source.statistic, curve, other);
    return value ? std::optional(source.times * *value) : std::nullopt;
  }
  std::optional<double> value = figure_at(run.said, source.figure);
  if (value && !source.less.empty()) {
    const std::optional<double> less = figure_at(run.said, source.less);
    value = less ? std::optional(*value - *less) : std::nullopt;
  }
  if (value && !source.per.empty()) {
    const std::optional<double> per = figure_at(run.said, source.per);
    value = per && *per != 0.0 ? std::optional(*value / *per) : std::nullopt;
  }
  return value ? std::optional(source.times * *value) : std::nullopt;
}

PicturePoints SharedRuns::line(const PictureLine& line) const {
  const Run& run = of(line.run);
  CurveSamples curve = samples_of(line.curve, *run.recording, run.said);
  if (!line.over) return {std::move(curve.time), std::move(curve.value)};
  auto [x, y] = pairs_of(samples_of(*line.over, *run.recording, run.said), curve);
  return {std::move(x), std::move(y)};
}

PicturePoints SharedRuns::dots(const PictureDots& dots) const {
  PicturePoints points;
  std::vector<std::string> names;
  for (const RunResult& result : *of(dots.run).results) {
    if (!dots.of.empty() && body_of(result) != dots.of) continue;
    if (names.empty()) names = csv_cells(csv_header(result));
    const std::vector<std::string> cells = csv_cells(csv_row(result));
    std::optional<double> x = cell(names, cells, dots.x);
    const std::optional<double> y = cell(names, cells, dots.y);
    if (x && !dots.x_less.empty()) {
      const std::optional<double> less = cell(names, cells, dots.x_less);
      x = less ? std::optional(*x - *less) : std::nullopt;
    }
    if (!x || !y) continue;
    points.x.push_back(dots.x_times * *x);
    points.y.push_back(dots.y_times * *y);
  }
  return points;
}

PictureShares SharedRuns::matrix(const PictureMatrix& matrix) const {
  const nlohmann::json& said = of(matrix.run).said;
  PictureShares shares;
  try {
    said.at(matrix.key).at("classes").get_to(shares.classes);
    said.at(matrix.key).at("rows").get_to(shares.rows);
  } catch (const nlohmann::json::exception&) {
    throw SetupError("'flinch " + matrix.run.commands.back().front() + "' prints no matrix '" + matrix.key +
                     "'");
  }
  return shares;
}

double SharedRuns::wall(const RunSource& source) const { return of(source).wall; }

}  // namespace flinch
