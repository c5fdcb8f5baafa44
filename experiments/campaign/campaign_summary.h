#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/campaign/campaign_results.h"
#include "experiments/campaign/run_result.h"

namespace flinch {

struct Campaign;

/// The runs of one point of the grid that touched the same sort of body.
struct CampaignGroup {
  std::size_t place = 0;                                ///< in the grid, whatever body was drawn
  std::vector<std::pair<std::string, std::string>> at;  ///< the grid's axes
  std::string estimator;                                ///< whose detections count
  std::string body;                                     ///< as RunResult::body
  std::size_t n = 0;                                    ///< runs
  std::size_t faults = 0;

  // Of runs whose contact no false alarm came before.
  std::size_t contacts = 0;
  std::size_t missed = 0;                ///< not detected within Campaign::missed_after
  std::optional<double> missed_at_most;  ///< share, 95 % exact bound; none without contacts
  /// Half and nine tenths of the contacts were detected so soon; none where too many were missed [s].
  std::optional<double> median, p90;
  /// Between these lies, with 95 %, what the median and the nine tenths of all such contacts are; none where
  /// there are too few contacts, or too many missed, to tell [s].
  std::array<std::optional<double>, 2> median_within, p90_within;
  /// So soon a tenth, a quarter, half, three quarters and nine tenths were detected, likewise [s].
  std::array<std::optional<double>, 5> quantiles;

  std::size_t false_alarms = 0;
  double contact_free = 0.0;  ///< [s]
  double false_alarms_per_hour = 0.0;
  double false_alarms_per_hour_at_most = 0.0;  ///< 95 % exact bound
  double largest_observer_error_force = 0.0;   ///< [N]
  double largest_observer_error_moment = 0.0;  ///< [Nm]
  double largest_tracking_error = 0.0;         ///< [m]
  double longest_over_limit = 0.0;             ///< above the limit of the force, in one run [s]
};

/// The smallest value within which at least this share of `count` lies; none where fewer are known.
std::optional<double> quantile(std::vector<double> values, std::size_t count, double share);

/// Adds runs up to a group.
class CollectedGroup {
 public:
  /// `missed_after`: a contact that is detected later counts as missed [s].
  void add(const RunResult& result, const EstimatorResult& estimator, double missed_after);
  /// What they add up to. Place, grid, body and estimator are left to who knows them.
  CampaignGroup group() const;

 private:
  CampaignGroup group_;
  std::vector<double> times_;  ///< of the contacts that were detected [s]
};

/// By point of the grid, then by body.
std::vector<CampaignGroup> groups_of(const Campaign& campaign, const CampaignResults& results);

/// Runs that a fault ended.
std::size_t faulted_runs(const CampaignResults& results);

/// Where a group stands in the grid, without the axes that have one value only.
std::vector<std::pair<std::string, std::string>> place_of(const CampaignGroup& group,
                                                          const Campaign& campaign);

/// How fast a campaign went, for who looks on; not part of its results.
struct CampaignPace {
  std::size_t runs_now = 0;  ///< done by this call
  double wall = 0.0;         ///< [s]
};

/// The groups as a table for people, and the campaign as one JSON object on one line. Later versions add keys
/// and rename none.
std::string campaign_table(const Campaign& campaign, const std::vector<CampaignGroup>& groups,
                           const CampaignPace& pace);
std::string campaign_json(const Campaign& campaign, const CampaignResults& results,
                          const std::vector<CampaignGroup>& groups, const CampaignPace& pace);

}  // namespace flinch
