#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "experiments/campaign/run_result.h"

namespace flinch {

struct Campaign;

/// The results of a campaign while it runs: a file to which each run adds its row as soon as it is done. A
/// program that is killed leaves whole rows and at most one torn one, which is left out; the next call goes
/// on where it stopped.
class CampaignJournal {
 public:
  /// Opens the journal in `folder`, or begins one. Throws SetupError where it cannot be read or written, and
  /// where it is that of another campaign.
  CampaignJournal(const std::filesystem::path& folder, const Campaign& campaign);

  /// What is done, by number of the run.
  const std::map<std::size_t, RunResult>& results() const { return results_; }

  /// Throws SetupError where the disk does not take it.
  void add(const RunResult& result);

 private:
  void read(const Campaign& campaign);
  /// The result's row, after its header where that is another than the last one's.
  std::string lines_of(const RunResult& result);

  std::filesystem::path file_;
  std::ofstream stream_;
  std::string header_;  ///< of the last row in the file
  std::map<std::size_t, RunResult> results_;
};

/// Writes `text` to `file`, first under another name. Throws SetupError when that fails.
void replace_file(const std::filesystem::path& file, const std::string& text);

}  // namespace flinch
