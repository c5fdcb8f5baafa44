#include "experiments/reproduction/reproduction.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_summary.h"
#include "experiments/campaign/reaction_summary.h"
#include "experiments/campaign/run_campaign.h"
#include "experiments/reproduction/figure_path.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "experiments/verdict/verdict_output.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Clock = std::chrono::steady_clock;

/// Runs that several figures may share, and what they said.
struct SharedRuns {
  FigureSource source;  ///< its figure is of no account
  std::optional<SimulatedScenario> scenario;
  std::optional<Campaign> campaign;
  nlohmann::json said;
  double wall = 0.0;

  double size() const { return campaign ? static_cast<double>(campaign->runs()) : 1.0; }
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The runs of all figures, each once, read and found good.
std::vector<SharedRuns> runs_of(const std::vector<PaperFigure>& figures) {
  std::vector<SharedRuns> all;
  std::vector<std::string> problems;
  const auto need = [&](const FigureSource& source) {
    const auto same = [&](const SharedRuns& runs) { return runs.source.shares_runs_with(source); };
    if (std::any_of(all.begin(), all.end(), same)) return;
    SharedRuns& runs = all.emplace_back();
    runs.source = source;
    try {
      if (source.is_campaign) {
        runs.campaign = read_campaign(source.file, {.set = source.set, .draws = source.runs});
      } else {
        runs.scenario = read_simulated_scenario(source.file, source.set);
      }
    } catch (const SetupError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  };
  for (const PaperFigure& figure : figures) {
    if (figure.as_printed) need(*figure.as_printed);
    if (figure.ours) need(*figure.ours);
  }
  throw_if_any(std::move(problems));
  return all;
}

/// A folder's name for a campaign: its own, and a number where it is not the first one of that name.
std::string folder_of(const std::vector<SharedRuns>& all, std::size_t which) {
  const std::string& name = all[which].campaign->name;
  const auto same = [&name](const SharedRuns& runs) { return runs.campaign && runs.campaign->name == name; };
  const auto before = std::count_if(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(which), same);
  return before == 0 ? name : name + "_" + std::to_string(before + 1);
}

nlohmann::json said_by(const Campaign& campaign, const CampaignResults& results) {
  const std::string text = campaign.summary == Campaign::Summary::reactions
                               ? reactions_json(campaign, reactions_of(results, campaign.missed_after), {})
                               : campaign_json(campaign, results, groups_of(campaign, results), {});
  return nlohmann::json::parse(text);
}

/// Tells how far all runs have come.
class Share {
 public:
  Share(const std::vector<SharedRuns>& all, const ReproductionProgress& progress) : progress_(progress) {
    for (const SharedRuns& runs : all) all_ += runs.size();
  }
  /// Besides what was added, `more` runs are done. False: stop.
  bool show(double more = 0.0) const { return !progress_ || progress_((done_ + more) / std::max(1.0, all_)); }
  void add(double runs) { done_ += runs; }

 private:
  const ReproductionProgress& progress_;
  double all_ = 0.0;
  double done_ = 0.0;
};

[[noreturn]] void stopped() {
  throw SetupError("stopped before all was run; the same command goes on with what its campaigns have done");
}

/// All single runs, several at once; each is judged while it runs.
void do_single_runs(std::vector<SharedRuns>& all, std::size_t threads, Share& share) {
  std::vector<SharedRuns*> single;
  for (SharedRuns& runs : all)
    if (runs.scenario) single.push_back(&runs);
  std::atomic<std::size_t> next = 0, done = 0;
  std::atomic<bool> stop = false;
  const auto work = [&] {
    for (std::size_t i = next++; i < single.size() && !stop; i = next++) {
      const Clock::time_point start = Clock::now();
      const Verdict verdict = judge_experiment(*single[i]->scenario);
      single[i]->said = nlohmann::json::parse(verdict_json(verdict, {}));
      single[i]->wall = seconds_since(start);
      ++done;
    }
  };
  std::vector<std::future<void>> workers;
  for (std::size_t i = 0; i < std::min(threads, single.size()); ++i)
    workers.push_back(std::async(std::launch::async, work));
  for (std::future<void>& worker : workers) {
    while (worker.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready)
      if (!share.show(static_cast<double>(done))) stop = true;
  }
  for (std::future<void>& worker : workers) worker.get();
  if (stop) stopped();
  share.add(static_cast<double>(single.size()));
}

void do_campaign(SharedRuns& runs, const std::filesystem::path& folder, std::size_t threads, Share& share) {
  const Clock::time_point start = Clock::now();
  bool goes_on = true;
  std::filesystem::create_directories(folder);
  const CampaignResults results = run_campaign(
      *runs.campaign, folder, threads,
      [&](std::size_t done, std::size_t) { return goes_on = share.show(static_cast<double>(done)); });
  if (!goes_on) stopped();
  runs.said = said_by(*runs.campaign, results);
  runs.wall = seconds_since(start);
  share.add(runs.size());
}

/// What a source says, and how long its runs took.
std::optional<double> value_of(const std::optional<FigureSource>& source, const std::vector<SharedRuns>& all,
                               double& wall) {
  if (!source) return std::nullopt;
  const auto runs = std::find_if(
      all.begin(), all.end(), [&](const SharedRuns& each) { return each.source.shares_runs_with(*source); });
  wall += runs->wall;
  const std::optional<double> whole = figure_at(runs->said, source->figure);
  if (!whole || source->less.empty()) return whole;
  const std::optional<double> less = figure_at(runs->said, source->less);
  return less ? std::optional(*whole - *less) : std::nullopt;
}

/// Whether `value` is as good as the paper's, or better.
bool is_as_good(const PaperFigure& figure, std::optional<double> value) {
  if (!value) return false;
  return (figure.better == PaperFigure::Better::lower && *value <= figure.paper) ||
         (figure.better == PaperFigure::Better::higher && *value >= figure.paper);
}

bool is_near(const PaperFigure& figure, std::optional<double> value) {
  if (!value || *value * figure.paper <= 0.0) return value == figure.paper;
  return std::abs(std::log(*value / figure.paper)) <= std::log(figure.within) * (1.0 + 1e-12);
}

}  // namespace

const char* word(ReproducedFigure::Outcome outcome) {
  switch (outcome) {
    case ReproducedFigure::Outcome::reproduced:
      return "reproduced";
    case ReproducedFigure::Outcome::better:
      return "better";
    case ReproducedFigure::Outcome::not_reached:
      break;
  }
  return "not reached";
}

ReproducedFigure judged(const PaperFigure& figure, std::optional<double> as_printed,
                        std::optional<double> ours) {
  using enum ReproducedFigure::Outcome;
  ReproducedFigure result{figure, as_printed, ours, not_reached, 0.0};
  if (is_as_good(figure, as_printed) || is_as_good(figure, ours)) result.outcome = better;
  if (is_near(figure, as_printed)) result.outcome = reproduced;
  return result;
}

std::vector<ReproducedFigure> reproduce(const std::vector<PaperFigure>& figures,
                                        const std::filesystem::path& folder, std::size_t threads,
                                        const ReproductionProgress& progress) {
  std::vector<SharedRuns> all = runs_of(figures);
  Share share(all, progress);
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  do_single_runs(all, threads, share);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].campaign) do_campaign(all[i], folder / folder_of(all, i), threads, share);
  std::vector<ReproducedFigure> reproduced;
  for (const PaperFigure& figure : figures) {
    double wall = 0.0;
    const auto as_printed = value_of(figure.as_printed, all, wall);
    const auto ours = value_of(figure.ours, all, wall);
    reproduced.push_back(judged(figure, as_printed, ours));
    reproduced.back().wall = wall;
  }
  return reproduced;
}

}  // namespace flinch
