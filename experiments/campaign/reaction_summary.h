#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "experiments/campaign/campaign_results.h"
#include "experiments/campaign/campaign_summary.h"
#include "experiments/campaign/run_result.h"

namespace flinch {

/// The runs of one law of the reaction that meant to touch the same sort of body.
struct ReactionGroup {
  std::string level;  ///< "velocity" of "velocity_reaction"; of other laws their name
  std::string body;   ///< that was meant to be touched, else that was
  std::size_t n = 0;
  std::size_t detected = 0;
  CampaignGroup detection;  ///< how, by the estimator that was followed; it has no name where that differs
  std::size_t class_right = 0, class_wrong = 0;  ///< of those in which one was accepted, and known to others
  std::size_t removed = 0;                       ///< contacts that were over before the end of the run
  std::optional<double> removed_median, removed_p95;  ///< from the onset; none where more stayed [s]
  std::optional<double> removed_largest;              ///< of those that were removed [s]
  std::optional<double> peak_median, peak_largest;    ///< [N]
  std::size_t over_limit = 0;                         ///< runs with a force above its limit
  double longest_over_limit = 0.0;                    ///< so long in one run [s]
  std::size_t violations_sigma_kappa = 0;             ///< runs beyond the safety value, see RunResult
  std::size_t violations_sigma_sc = 0;
  std::size_t starts_inside = 0;  ///< runs that start within both safety values, and of these beyond them:
  std::size_t starts_inside_violations_sigma_kappa = 0, starts_inside_violations_sigma_sc = 0;
  std::size_t final_inside = 0;  ///< runs that ended within 5 % of sigma_kappa's and 5 mm of sigma_sc's limit
  /// Runs whose robot keeps the safety values and could, and could not, stop within them when it detected the
  /// contact, and how many of the former went beyond one nevertheless.
  std::size_t could_stop = 0, could_not_stop = 0, violations_could_stop = 0;
  std::size_t self_collisions = 0;
  std::size_t gate_faults = 0;
};

/// peak force = intercept + slope speed, by least squares. [SafePR] Table V
struct ForceFit {
  std::string body;
  std::size_t n = 0;
  double slope = 0.0;      ///< [N/(m/s)]
  double intercept = 0.0;  ///< [N]
  double pearson = 0.0;    ///< r
  /// At which the line reaches the limits [m/s]; none where it does not, or limits differ between runs.
  std::optional<double> speed_at_transient, speed_at_quasi_static;
};

struct ReactionSummary {
  std::vector<ReactionGroup> groups;   ///< by level, then by body
  std::vector<ForceFit> fits;          ///< of each body over all levels, with three or more runs
  std::optional<ForceFit> fit_of_all;  ///< of all bodies together, likewise
};

/// The limits of sigma_kappa and sigma_sc are those of the runs. `missed_after`: as in Campaign [s].
ReactionSummary reactions_of(const CampaignResults& results, double missed_after = 0.1);

/// "velocity" of "velocity_reaction"; other laws as they are called.
std::string level_of(const std::string& law);

/// The body that was meant to be touched, else that was.
std::string body_of(const RunResult& result);

/// A table for people, and one JSON object on one line.
std::string reactions_table(const Campaign& campaign, const ReactionSummary& summary);
std::string reactions_json(const Campaign& campaign, const ReactionSummary& summary,
                           const CampaignPace& pace);

/// The least-squares line through the points (x_i, y_i); none below three points or where all x are the same.
std::optional<ForceFit> fit_line(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace flinch
