#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flinch {

struct CampaignRun;
struct Verdict;

/// What a detector saw that follows an estimator.
struct EstimatorResult {
  std::string name;
  /// From the onset [s]; none: not detected, or nothing was touched.
  std::optional<double> detection_time = std::nullopt;
  bool false_alarm = false;  ///< something was detected before anything was touched
  /// Until the first touch or detection, or the end [s]: by this detector or, after which the robot does
  /// something else, by the one that is followed.
  double contact_free = 0.0;
};

/// What one run of a campaign showed: one row of its table.
struct RunResult {
  std::size_t run = 0;
  std::size_t point = 0;  ///< of the grid
  std::size_t draw = 0;
  std::uint64_t seed = 0;
  int attempts = 1;
  std::vector<std::pair<std::string, std::string>> values;  ///< as CampaignRun::values

  bool good = false;  ///< the verdict
  std::string fault;  ///< why the torque gate closed; "" if it did not
  /// What was touched first: "platform", "link1", "link2" of any leg, "clamping", "push"; "none".
  std::string body = "none";
  std::optional<double> removal_time;  ///< from the onset [s]
  std::optional<double> speed;         ///< of the platform at the onset [m/s]
  std::optional<double> peak_force;    ///< [N]
  /// Of what was touched first, the largest after the transient duration; none: it did not last so long [N].
  std::optional<double> lasting_force;
  double over_limit = 0.0;  ///< time above the limit of the force, of all contacts [s]
  std::optional<double> transient_limit, quasi_static_limit;  ///< by which forces are judged [N]
  /// Whether the robot took for touched what was; none: it was never sure, or nobody else knows.
  std::optional<bool> class_right;
  /// What the scenario means to be touched, as `body`; "" where it does not say.
  std::string meant;
  std::string law;  ///< of the reaction: "torque_reaction"
  // Of the true robot, from the first detection on; where limits are kept always, from the start.
  std::optional<double> sigma_kappa_least, sigma_kappa_most, sigma_kappa_last;
  std::optional<double> sigma_sc_least, sigma_sc_most, sigma_sc_last;  ///< [m]
  std::optional<bool> starts_inside;                                   ///< the run, within both safety values
  bool violates_sigma_kappa = false;                                   ///< beyond its safety value
  bool violates_sigma_sc = false;                                      ///< likewise
  bool ends_inside = false;  ///< at the end within 5 % of sigma_kappa's and 5 mm of sigma_sc's safety value
  bool self_contact = false;
  /// Whether the robot could stop within both safety values when it detected the first contact; none: not
  /// judged, or it keeps wider limits.
  std::optional<bool> could_stop;
  std::optional<double> largest_torque;  ///< as in Verdict [Nm or N]
  double observer_error_force = 0.0;     ///< as in Verdict [N]
  double observer_error_moment = 0.0;    ///< [Nm]
  double tracking_error = 0.0;           ///< [m]
  double simulated = 0.0;                ///< [s]

  std::vector<EstimatorResult> estimators;  ///< first the one that the robot followed
  /// Of a campaign of single runs: the verdict as verdict_json() has it; "" otherwise.
  std::string figures;
};

RunResult result_of(const CampaignRun& run, const Verdict& verdict);

/// The header of a table in CSV, and a row of it, without the end of the line. The drawn values and the
/// estimators of `result` name some of the columns. Numbers are written so that reading them gives the same
/// bits; what is not known is empty.
std::string csv_header(const RunResult& result);
std::string csv_row(const RunResult& result);

/// The reverse, for rows below a header with the cells `names`. None where `row` is no whole row.
std::optional<RunResult> parse_csv_row(const std::vector<std::string>& names, const std::string& row);

/// A cell of CSV, in quotes where it needs them.
std::string csv_cell(const std::string& text);

/// The cells of a line of CSV; none where quotes do not match.
std::vector<std::string> csv_cells(const std::string& line);

}  // namespace flinch
