#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/run_result.h"
#include "experiments/speed_limit/speed_search.h"

namespace flinch {

/// Contacts with one body, each drawn once, that are tried at any speed of the platform: obstacle, noise and
/// robot stay what they are, and only the speed differs.
class ContactTrials {
 public:
  /// Draws `count` contacts of `campaign`, which has one scenario with a passage, no grid and one body: those
  /// in which that body is the first to be touched at `slowest` [m/s]. Throws SetupError with the reason
  /// where none can be drawn, or where most are not.
  ContactTrials(const Campaign& campaign, double slowest, std::size_t count);

  /// Contact number `trial` at `speed` [m/s], watched until 0.3 s after its transient duration.
  TrialResult operator()(std::size_t trial, double speed);

  /// Of all trials at `speed` that were within the limits, the run that came nearest to one; null: none was.
  /// Its values are the body, the place of the obstacle and the duration.
  const RunResult* nearest(double speed) const;

 private:
  struct Drawn {
    CampaignRun run;                         ///< At the slowest speed.
    std::shared_ptr<const ConfigNode> root;  ///< Of its scenario.
    TrialResult at_slowest = {};
  };

  TrialResult run_at(const Drawn& drawn, double speed);

  const Campaign& campaign_;
  double slowest_;
  std::vector<Drawn> drawn_;
  std::size_t false_alarms_ = 0;  ///< In trials that were not tested.
  std::map<double, RunResult> nearest_;
};

}  // namespace flinch
