#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "experiments/campaign/campaign_results.h"
#include "experiments/campaign/run_result.h"

namespace flinch {

struct Campaign;

/// Throws SetupError where `folder` has the results of another campaign.
void require_no_other_results(const std::filesystem::path& folder, const Campaign& campaign);

/// The results of a campaign while it runs: a file to which each run adds its row as soon as it is done. A
/// program that is killed leaves whole rows and at most one torn one, which is left out; the next call goes
/// on where it stopped.
class CampaignJournal {
 public:
  /// Opens the journal in `folder`, or begins one. Throws SetupError where it cannot be read or written, and
  /// where it is that of another campaign.
  CampaignJournal(const std::filesystem::path& folder, const Campaign& campaign);

  /// How many runs are done, and whether one of them is.
  std::size_t done() const { return done_; }
  bool has(std::size_t run) const { return is_done_[run]; }

  /// Throws SetupError where the disk does not take it. A run that is done already is left as it is.
  void add(const RunResult& result);

  /// All that is done, in the order of the numbers. What stays in memory of a run is where its row stands in
  /// the file. Throws SetupError where the file cannot be read; so does reading a result.
  CampaignResults results() const;

 private:
  /// Told of a whole row: its result, the header that it stands below, and its place in the file.
  using TakeRow =
      std::function<void(const RunResult&, const std::vector<std::string>& names, std::streamoff at)>;

  /// The file's rows; at their end where there is no file. Throws SetupError for that of another campaign.
  std::ifstream rows() const;
  void read(std::ifstream rows, const TakeRow& take) const;
  /// The result's row, after its header where that is another than the last one's.
  std::string lines_of(const RunResult& result);

  std::filesystem::path file_;
  std::string way_out_;  ///< where the file is that of another campaign
  std::ofstream stream_;
  std::string first_line_;
  std::string header_;  ///< of the last row in the file
  std::vector<bool> is_done_;
  std::size_t done_ = 0;
};

}  // namespace flinch
