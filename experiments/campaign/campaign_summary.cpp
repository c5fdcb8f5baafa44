#include "experiments/campaign/campaign_summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/exact_bounds.h"
#include "systems/foundation/json_text.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

/// The scenario and the axes of the grid, without what was drawn.
std::vector<std::pair<std::string, std::string>> axes_of(const Campaign& campaign, const RunResult& result) {
  const std::size_t count = campaign.grid.size() + (campaign.scenarios.size() > 1 ? 1U : 0U);
  return {result.values.begin(), result.values.begin() + static_cast<std::ptrdiff_t>(count)};
}

std::string milliseconds(std::optional<double> time) {
  return time ? fmt::format("{:.1f}", 1e3 * *time) : "-";
}

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json in_ms(std::optional<double> time) { return time ? Json(1e3 * *time) : Json(nullptr); }

std::string line_of(const std::vector<std::pair<std::string, std::string>>& place) {
  std::string text;
  for (const auto& [key, value] : place) text += (text.empty() ? "" : ", ") + key + " = " + value;
  return text;
}

}  // namespace

std::optional<double> quantile(std::vector<double> values, std::size_t count, double share) {
  const auto place = static_cast<std::size_t>(std::ceil(share * static_cast<double>(count)));
  if (place == 0 || place > values.size()) return std::nullopt;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place - 1), values.end());
  return values[place - 1];
}

namespace {

/// Order statistics around a quantile of `count` values: `values`, sorted, and larger ones that nobody knows.
std::array<std::optional<double>, 2> within(const std::vector<double>& values, std::size_t count,
                                            double share) {
  const RankBounds ranks = ranks_around_quantile(count, share);
  const auto value_at = [&](std::optional<std::size_t> rank) {
    return rank && *rank <= values.size() ? std::optional(values[*rank - 1]) : std::nullopt;
  };
  return {value_at(ranks.lower), value_at(ranks.upper)};
}

}  // namespace

void CollectedGroup::add(const RunResult& result, const EstimatorResult& estimator, double missed_after) {
  ++group_.n;
  group_.faults += result.fault.empty() ? 0U : 1U;
  group_.false_alarms += estimator.false_alarm ? 1U : 0U;
  group_.contact_free += estimator.contact_free;
  const auto keep_largest = [](double value, double& largest) { largest = std::max(largest, value); };
  keep_largest(result.observer_error_force, group_.largest_observer_error_force);
  keep_largest(result.observer_error_moment, group_.largest_observer_error_moment);
  keep_largest(result.tracking_error, group_.largest_tracking_error);
  keep_largest(result.over_limit, group_.longest_over_limit);
  if (result.body == "none" || estimator.false_alarm) return;
  ++group_.contacts;
  if (estimator.detection_time && *estimator.detection_time <= missed_after) {
    times_.push_back(*estimator.detection_time);
  } else {
    ++group_.missed;
  }
}

CampaignGroup CollectedGroup::group() const {
  CampaignGroup group = group_;
  if (group.contacts > 0) group.missed_at_most = clopper_pearson_upper(group.missed, group.contacts);
  static constexpr std::array shares = {0.1, 0.25, 0.5, 0.75, 0.9};
  for (std::size_t i = 0; i < shares.size(); ++i)
    group.quantiles[i] = quantile(times_, group.contacts, shares[i]);
  std::vector<double> sorted = times_;
  std::sort(sorted.begin(), sorted.end());
  group.median = group.quantiles[2];
  group.median_within = within(sorted, group.contacts, 0.5);
  group.p90 = group.quantiles[4];
  group.p90_within = within(sorted, group.contacts, 0.9);
  const double hours = group.contact_free / 3600.0;
  group.false_alarms_per_hour = hours > 0.0 ? static_cast<double>(group.false_alarms) / hours : 0.0;
  group.false_alarms_per_hour_at_most = garwood_upper(group.false_alarms, hours);
  return group;
}

std::vector<CampaignGroup> groups_of(const Campaign& campaign, const CampaignResults& results) {
  const std::size_t bodies = campaign.contact ? campaign.contact->bodies.size() : 1;
  struct Collected {
    std::vector<std::pair<std::string, std::string>> at;
    std::string estimator;
    CollectedGroup runs;
  };
  // Place of the point and of the estimator, and the body.
  std::map<std::tuple<std::size_t, std::string, std::size_t>, Collected> collected;
  for (const RunResult& result : results) {
    // The last digit of a point is the body that was drawn; runs are grouped by what was touched.
    const std::size_t point = result.point % (campaign.grid_points() / bodies);
    for (std::size_t i = 0; i < result.estimators.size(); ++i) {
      Collected& here = collected[{point, result.body, i}];
      if (here.estimator.empty()) {
        here.at = axes_of(campaign, result);
        here.estimator = result.estimators[i].name;
      }
      here.runs.add(result, result.estimators[i], campaign.missed_after);
    }
  }
  std::vector<CampaignGroup> groups;
  for (const auto& [key, here] : collected) {
    CampaignGroup& group = groups.emplace_back(here.runs.group());
    std::tie(group.place, group.body, std::ignore) = key;
    group.at = here.at;
    group.estimator = here.estimator;
  }
  return groups;
}

std::size_t faulted_runs(const CampaignResults& results) {
  return static_cast<std::size_t>(std::count_if(
      results.begin(), results.end(), [](const RunResult& result) { return !result.fault.empty(); }));
}

std::vector<std::pair<std::string, std::string>> place_of(const CampaignGroup& group,
                                                          const Campaign& campaign) {
  auto place = group.at;
  std::erase_if(place, [&](const auto& entry) {
    return std::any_of(campaign.grid.begin(), campaign.grid.end(), [&](const CampaignAxis& axis) {
      return axis.key == entry.first && axis.values.size() == 1;
    });
  });
  return place;
}

std::string campaign_table(const Campaign& campaign, const std::vector<CampaignGroup>& groups,
                           const CampaignPace& pace) {
  std::string text = fmt::format("{}: {} runs", campaign.title, campaign.runs());
  if (pace.runs_now > 0) {
    text += fmt::format(", {} of them now, {:.0f} a second", pace.runs_now,
                        static_cast<double>(pace.runs_now) / pace.wall);
  }
  text += "\n";
  std::string at = "?";
  for (const CampaignGroup& group : groups) {
    if (const std::string here = line_of(place_of(group, campaign)); here != at) {
      at = here;
      if (!at.empty()) text += "\n" + at + "\n";
      text += fmt::format("{:<10} {:<24} {:>6} {:>7} {:>9} {:>8} {:>8} {:>12} {:>12} {:>7}\n", "touched",
                          "detected by", "runs", "missed", "at most", "median", "p90", "false alarms",
                          "at most", "faults");
      text += fmt::format("{:<10} {:<24} {:>6} {:>7} {:>9} {:>8} {:>8} {:>12} {:>12} {:>7}\n", "", "", "", "",
                          "(95 %)", "[ms]", "[ms]", "[1/h]", "(95 %)", "");
    }
    text += fmt::format("{:<10} {:<24} {:>6} {:>7} {:>9} {:>8} {:>8} {:>12.1f} {:>12.1f} {:>7}\n", group.body,
                        group.estimator, group.n, group.contacts > 0 ? fmt::format("{}", group.missed) : "-",
                        group.missed_at_most ? fmt::format("{:.2f} %", 100.0 * *group.missed_at_most) : "-",
                        milliseconds(group.median), milliseconds(group.p90), group.false_alarms_per_hour,
                        group.false_alarms_per_hour_at_most, group.faults);
  }
  return text;
}

std::string campaign_json(const Campaign& campaign, const CampaignResults& results,
                          const std::vector<CampaignGroup>& groups, const CampaignPace& pace) {
  Json list = Json::array();
  for (const CampaignGroup& group : groups) {
    Json at = Json::object();
    for (const auto& [key, value] : group.at) at[key] = value;
    list.push_back(
        {{"estimator", group.estimator},
         {"body", group.body},
         {"n", group.n},
         {"missed", group.missed},
         {"median_ms", in_ms(group.median)},
         {"p90_ms", in_ms(group.p90)},
         {"median_ms_within", {in_ms(group.median_within[0]), in_ms(group.median_within[1])}},
         {"p90_ms_within", {in_ms(group.p90_within[0]), in_ms(group.p90_within[1])}},
         {"false_alarms_per_h", group.false_alarms_per_hour},
         {"at", at},
         {"contacts", group.contacts},
         {"missed_share_at_most", group.missed_at_most ? Json(*group.missed_at_most) : Json(nullptr)},
         {"false_alarms", group.false_alarms},
         {"contact_free_h", group.contact_free / 3600.0},
         {"false_alarms_per_h_at_most", finite(group.false_alarms_per_hour_at_most)},
         {"faults", group.faults},
         {"observer_error_force_N", group.largest_observer_error_force},
         {"observer_error_moment_Nm", group.largest_observer_error_moment},
         {"tracking_error_m", group.largest_tracking_error},
         {"over_limit_ms_max", 1e3 * group.longest_over_limit}});
  }
  const double rate = pace.wall > 0.0 ? static_cast<double>(pace.runs_now) / pace.wall : 0.0;
  return json_text(Json{{"campaign", campaign.name},
                        {"runs", campaign.runs()},
                        {"failed", faulted_runs(results)},
                        {"wall_s", pace.wall},
                        {"runs_per_s", rate},
                        {"groups", list}});
}

}  // namespace flinch
