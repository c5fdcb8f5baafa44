#include "experiments/campaign/run_campaign.h"

#include <fmt/core.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_helpers.h"
#include "experiments/campaign/campaign_journal.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/results_file.h"
#include "experiments/simulated/experiment.h"
#include "experiments/verdict/verdict.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// Hands out the numbers of the runs that are to be done, and takes their results in.
class WorkList {
 public:
  WorkList(CampaignJournal& journal, std::size_t runs) : journal_(journal), runs_(runs) { skip_done(); }

  /// The next run; none once all are given out, or the work was ended.
  std::optional<std::size_t> next() {
    const std::lock_guard lock(mutex_);
    if (ended_ || next_ >= runs_) return std::nullopt;
    const std::size_t number = next_++;
    skip_done();
    return number;
  }

  void add(const RunResult& result) {
    const std::lock_guard lock(mutex_);
    journal_.add(result);
    changed_.notify_one();
  }

  /// Nothing more is given out.
  void end(std::exception_ptr why = nullptr) {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    if (why && !problem_) problem_ = std::move(why);
    changed_.notify_one();
  }

  /// Runs that are done, once that changed or `patience` has passed.
  std::size_t wait_for_change(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, patience);
    return journal_.done();
  }

  bool ended() {
    const std::lock_guard lock(mutex_);
    return ended_ || journal_.done() >= runs_;
  }

  void rethrow_problem() const {
    if (problem_) std::rethrow_exception(problem_);
  }

 private:
  void skip_done() {
    while (next_ < runs_ && journal_.has(next_)) ++next_;
  }

  CampaignJournal& journal_;
  std::size_t runs_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t next_ = 0;
  bool ended_ = false;
  std::exception_ptr problem_;
};

void work(const Campaign& campaign, WorkList& list) {
  try {
    while (const auto number = list.next()) list.add(do_run(campaign, *number));
  } catch (...) {
    list.end(std::current_exception());
  }
}

/// A run that is done is simulated once more: were it another now, rows of two programs would stand in one
/// table.
void require_same_outcome(const Campaign& campaign, const CampaignJournal& journal,
                          const std::filesystem::path& folder) {
  if (journal.done() == 0 || journal.done() == campaign.runs()) return;
  const RunResult before = journal.results()[0];
  if (csv_row(do_run(campaign, before.run)) == csv_row(before)) return;
  throw SetupError(fmt::format(
      "{}: run {} comes out otherwise now: another build of the program or another machine has made it; "
      "go on with that one, choose another folder with --out, or begin anew with --fresh",
      folder.string(), before.run));
}

/// The results as tables have them.
CampaignResults without_figures(const CampaignResults& results) {
  return {results.size(), [results](std::size_t place) {
            RunResult result = results[place];
            result.figures.clear();
            return result;
          }};
}

}  // namespace

RunResult simulate_run(const CampaignRun& run) { return result_of(run, judge_experiment(run.scenario)); }

RunResult do_run(const Campaign& campaign, std::size_t number) {
  return campaign.task ? campaign.task->result_of(number) : simulate_run(draw_run(campaign, number));
}

CampaignResults run_campaign(const Campaign& campaign, const std::filesystem::path& folder,
                             std::size_t threads, const CampaignProgress& progress,
                             CampaignHelpers* helpers) {
  CampaignJournal journal(folder, campaign);
  require_same_outcome(campaign, journal, folder);
  const std::size_t done_before = journal.done();
  WorkList list(journal, campaign.runs());
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  {
    std::vector<std::jthread> workers;
    for (std::size_t i = 0; i < threads; ++i) workers.emplace_back([&] { work(campaign, list); });
    // Helpers that ask have another run in hand, and so can wait for a millisecond.
    const std::chrono::milliseconds patience(helpers != nullptr ? 1 : 100);
    while (!list.ended()) {
      const std::size_t done = list.wait_for_change(patience);
      if (helpers != nullptr)
        helpers->serve([&] { return list.next(); }, [&](const RunResult& result) { list.add(result); });
      if (progress && !progress(done, done_before)) list.end();
    }
  }
  list.rethrow_problem();
  CampaignResults results = journal.results();
  if (results.size() == campaign.runs()) write_results(without_figures(results), folder);
  return results;
}

}  // namespace flinch
