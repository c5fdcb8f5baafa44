#pragma once

#include <string>
#include <vector>

#include "experiments/campaign/campaign_helpers.h"

namespace flinch {

/// The programs that mpirun or srun has started together, by MPI. Rank 0 leads. To be made once in a program.
///
/// Each other rank always has one run in hand and one in store, so that it does not wait for an answer. What
/// a rank sends is the row of a run's table, in which numbers are exact. Where a rank is lost, mpirun ends
/// all of them; the journal has every run whose row had come, and the same call does the rest.
class CampaignRanks final : public CampaignHelpers {
 public:
  /// Joins the others. Throws SetupError where they read another campaign than rank 0.
  explicit CampaignRanks(const Campaign& campaign);
  /// Rank 0 tells all others that there is nothing more to do, and waits until each has finished its run.
  ~CampaignRanks() override;
  CampaignRanks(const CampaignRanks&) = delete;
  CampaignRanks& operator=(const CampaignRanks&) = delete;

  bool leads() const override { return rank_ == 0; }
  void work(const Campaign& campaign) override;
  void serve(const NextRun& next, const TakeResult& take) override;

 private:
  void answer(const NextRun& next, const TakeResult& take);

  int rank_ = 0;
  std::vector<int> asking_;  ///< of each rank: how often it will still ask before it ends
};

}  // namespace flinch
