#include "experiments/campaign/reaction_summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "experiments/campaign/campaign.h"
#include "systems/foundation/json_text.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

struct Collected {
  ReactionGroup group;
  CollectedGroup detection;
  std::string estimator;
  std::vector<double> removals, peaks;

  void add(const RunResult& result, double missed_after) {
    ++group.n;
    if (!result.estimators.empty()) {
      const EstimatorResult& followed = result.estimators.front();
      if (group.n == 1) estimator = followed.name;
      if (estimator != followed.name) estimator.clear();
      detection.add(result, followed, missed_after);
    }
    const bool detected = !result.estimators.empty() && result.estimators.front().detection_time.has_value();
    group.detected += detected ? 1U : 0U;
    if (result.class_right) ++(*result.class_right ? group.class_right : group.class_wrong);
    if (result.removal_time) removals.push_back(*result.removal_time);
    if (result.peak_force) peaks.push_back(*result.peak_force);
    group.over_limit += result.over_limit > 0.0 ? 1U : 0U;
    group.longest_over_limit = std::max(group.longest_over_limit, result.over_limit);
    group.violations_sigma_kappa += result.violates_sigma_kappa ? 1U : 0U;
    group.violations_sigma_sc += result.violates_sigma_sc ? 1U : 0U;
    if (result.starts_inside.value_or(false)) {
      ++group.starts_inside;
      group.starts_inside_violations_sigma_kappa += result.violates_sigma_kappa ? 1U : 0U;
      group.starts_inside_violations_sigma_sc += result.violates_sigma_sc ? 1U : 0U;
    }
    group.final_inside += result.ends_inside ? 1U : 0U;
    if (result.could_stop) ++(*result.could_stop ? group.could_stop : group.could_not_stop);
    const bool violates = result.violates_sigma_kappa || result.violates_sigma_sc;
    group.violations_could_stop += violates && result.could_stop.value_or(false) ? 1U : 0U;
    group.self_collisions += result.self_contact ? 1U : 0U;
    group.gate_faults += result.fault.empty() ? 0U : 1U;
  }

  ReactionGroup finished() {
    group.detection = detection.group();
    group.detection.estimator = estimator;
    group.removed = removals.size();
    group.removed_median = quantile(removals, group.n, 0.5);
    group.removed_p95 = quantile(removals, group.n, 0.95);
    group.removed_largest = quantile(removals, removals.size(), 1.0);
    group.peak_median = quantile(peaks, peaks.size(), 0.5);
    group.peak_largest = quantile(peaks, peaks.size(), 1.0);
    return group;
  }
};

/// Speeds and forces of runs, and the limits where all have the same.
struct Forces {
  std::vector<double> speeds, peaks;
  std::optional<double> transient, quasi_static;

  void add(const RunResult& result) {
    if (!result.speed || !result.peak_force) return;
    const auto keep_common = [&](const std::optional<double>& limit, std::optional<double>& common) {
      if (speeds.empty()) common = limit;
      if (common != limit) common.reset();
    };
    keep_common(result.transient_limit, transient);
    keep_common(result.quasi_static_limit, quasi_static);
    speeds.push_back(*result.speed);
    peaks.push_back(*result.peak_force);
  }

  std::optional<ForceFit> line(const std::string& body) const {
    std::optional<ForceFit> fit = fit_line(speeds, peaks);
    if (!fit) return fit;
    fit->body = body;
    const auto speed_at = [&](const std::optional<double>& force) -> std::optional<double> {
      if (!force || !(fit->slope > 0.0) || *force < fit->intercept) return std::nullopt;
      return (*force - fit->intercept) / fit->slope;
    };
    fit->speed_at_transient = speed_at(transient);
    fit->speed_at_quasi_static = speed_at(quasi_static);
    return fit;
  }
};

std::string fit_line_text(const ForceFit& fit) {
  const auto known = [](const std::optional<double>& speed) {
    return speed ? fmt::format("{:.2f}", *speed) : std::string("-");
  };
  return fmt::format("{:<10} {:>5} {:>7.3f} {:>8.0f} {:>6.0f} {:>10} {:>12}\n", fit.body, fit.n, fit.pearson,
                     fit.slope, fit.intercept, known(fit.speed_at_transient),
                     known(fit.speed_at_quasi_static));
}

std::string text_of(std::optional<double> value, double scale) {
  return value ? fmt::format("{:.0f}", scale * *value) : "-";
}

Json json_of(std::optional<double> value, double scale = 1.0) {
  return value ? Json(scale * *value) : Json(nullptr);
}

Json detection_json(const CampaignGroup& detection) {
  const double most = detection.false_alarms_per_hour_at_most;
  return {{"estimator", detection.estimator.empty() ? Json(nullptr) : Json(detection.estimator)},
          {"contacts", detection.contacts},
          {"missed", detection.missed},
          {"missed_share_at_most", json_of(detection.missed_at_most)},
          {"median_ms", json_of(detection.median, 1e3)},
          {"p90_ms", json_of(detection.p90, 1e3)},
          {"false_alarms", detection.false_alarms},
          {"contact_free_h", detection.contact_free / 3600.0},
          {"false_alarms_per_h", detection.false_alarms_per_hour},
          {"false_alarms_per_h_at_most", std::isfinite(most) ? Json(most) : Json(nullptr)}};
}

Json fit_json(const ForceFit& fit) {
  return {{"body", fit.body},
          {"n", fit.n},
          {"slope_N_s_per_m", fit.slope},
          {"intercept_N", fit.intercept},
          {"pearson", fit.pearson},
          {"speed_at_transient_limit_m_per_s", json_of(fit.speed_at_transient)},
          {"speed_at_quasi_static_limit_m_per_s", json_of(fit.speed_at_quasi_static)}};
}

bool is_judged(const ReactionGroup& group) { return group.could_stop + group.could_not_stop > 0; }

/// Null for levels that do not keep the safety values, which nobody judged.
Json could_stop_json(const ReactionGroup& group, std::size_t count) {
  return is_judged(group) ? Json(count) : Json(nullptr);
}

/// Of the levels that keep the safety values.
std::string could_stop_lines(const ReactionSummary& summary) {
  std::string text;
  for (const ReactionGroup& group : summary.groups) {
    if (!is_judged(group)) continue;
    text += fmt::format("{:<14} {:<10} {:>5} {:>10} {:>13}\n", group.level, group.body, group.could_stop,
                        group.could_not_stop, group.violations_could_stop);
  }
  if (text.empty()) return "";
  return fmt::format("\nwhen detected, within the safety values\n{:<14} {:<10} {:>5} {:>10} {:>13}\n{}",
                     "level", "body", "could", "could not", "could, beyond", text);
}

}  // namespace

std::string level_of(const std::string& law) {
  const std::string suffix = "_reaction";
  return law.ends_with(suffix) ? law.substr(0, law.size() - suffix.size()) : law;
}

std::string body_of(const RunResult& result) { return result.meant.empty() ? result.body : result.meant; }

std::optional<ForceFit> fit_line(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = std::min(x.size(), y.size());
  if (n < 3) return std::nullopt;
  double mean_x = 0.0, mean_y = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    mean_x += x[i] / static_cast<double>(n);
    mean_y += y[i] / static_cast<double>(n);
  }
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
  }
  if (!(xx > 0.0)) return std::nullopt;
  ForceFit fit;
  fit.n = n;
  fit.slope = xy / xx;
  fit.intercept = mean_y - fit.slope * mean_x;
  fit.pearson = yy > 0.0 ? xy / std::sqrt(xx * yy) : 0.0;
  return fit;
}

ReactionSummary reactions_of(const CampaignResults& results, double missed_after) {
  std::map<std::pair<std::string, std::string>, Collected> collected;
  std::map<std::string, Forces> forces;
  Forces of_all;
  for (const RunResult& result : results) {
    const std::string body = body_of(result);
    Collected& group = collected[{level_of(result.law), body}];
    group.group.level = level_of(result.law);
    group.group.body = body;
    group.add(result, missed_after);
    forces[body].add(result);
    of_all.add(result);
  }
  ReactionSummary summary;
  for (auto& [key, group] : collected) summary.groups.push_back(group.finished());
  for (const auto& [body, points] : forces) {
    if (const auto fit = points.line(body)) summary.fits.push_back(*fit);
  }
  summary.fit_of_all = of_all.line("all");
  return summary;
}

std::string reactions_table(const Campaign& campaign, const ReactionSummary& summary) {
  std::string text = fmt::format("{}: {} runs\n\n", campaign.title, campaign.runs());
  const auto add_line = [&text](const auto&... cells) {
    text += fmt::format(
        "{:<12} {:<8} {:>4} {:>8} {:>7} {:>7} {:>15} {:>11} {:>5} {:>6} {:>9} {:>9} {:>6} {:>7} {:>6}\n",
        cells...);
  };
  add_line("level", "body", "runs", "detected", "class", "removed", "removed ms", "peak N", "over", "starts",
           "kappa", "sc", "inside", "self", "gate");
  add_line("", "", "", "", "r./wr.", "", "median/p95/most", "median/most", "limit", "inside", "of it/all",
           "of it/all", "at end", "contact", "faults");
  for (const ReactionGroup& group : summary.groups) {
    add_line(group.level, group.body, group.n, group.detected,
             fmt::format("{}/{}", group.class_right, group.class_wrong), group.removed,
             text_of(group.removed_median, 1e3) + "/" + text_of(group.removed_p95, 1e3) + "/" +
                 text_of(group.removed_largest, 1e3),
             text_of(group.peak_median, 1.0) + "/" + text_of(group.peak_largest, 1.0), group.over_limit,
             group.starts_inside,
             fmt::format("{}/{}", group.starts_inside_violations_sigma_kappa, group.violations_sigma_kappa),
             fmt::format("{}/{}", group.starts_inside_violations_sigma_sc, group.violations_sigma_sc),
             group.final_inside, group.self_collisions, group.gate_faults);
  }
  text +=
      could_stop_lines(summary) + "\npeak force over speed, and the speed at which it reaches the limits\n";
  text += fmt::format("{:<10} {:>5} {:>7} {:>8} {:>6} {:>10} {:>12}\n", "body", "runs", "r", "N/(m/s)", "N",
                      "transient", "quasi-static");
  for (const ForceFit& fit : summary.fits) text += fit_line_text(fit);
  if (summary.fit_of_all) text += fit_line_text(*summary.fit_of_all);
  return text;
}

std::string reactions_json(const Campaign& campaign, const ReactionSummary& summary,
                           const CampaignPace& pace) {
  Json groups = Json::array(), fits = Json::array();
  std::size_t failed = 0;
  for (const ReactionGroup& group : summary.groups) {
    failed += group.gate_faults;
    groups.push_back({{"level", group.level},
                      {"body", group.body},
                      {"n", group.n},
                      {"detected", group.detected},
                      {"class_right", group.class_right},
                      {"class_wrong", group.class_wrong},
                      {"removed", group.removed},
                      {"removed_median_ms", json_of(group.removed_median, 1e3)},
                      {"removed_p95_ms", json_of(group.removed_p95, 1e3)},
                      {"removed_max_ms", json_of(group.removed_largest, 1e3)},
                      {"peak_median_N", json_of(group.peak_median)},
                      {"peak_max_N", json_of(group.peak_largest)},
                      {"over_limit", group.over_limit},
                      {"over_limit_ms_max", 1e3 * group.longest_over_limit},
                      {"violations_sigma_kappa", group.violations_sigma_kappa},
                      {"violations_sigma_sc", group.violations_sigma_sc},
                      {"starts_inside", group.starts_inside},
                      {"starts_inside_violations_sigma_kappa", group.starts_inside_violations_sigma_kappa},
                      {"starts_inside_violations_sigma_sc", group.starts_inside_violations_sigma_sc},
                      {"final_inside", group.final_inside},
                      {"could_stop", could_stop_json(group, group.could_stop)},
                      {"could_not_stop", could_stop_json(group, group.could_not_stop)},
                      {"violations_could_stop", could_stop_json(group, group.violations_could_stop)},
                      {"self_collisions", group.self_collisions},
                      {"gate_faults", group.gate_faults}});
    groups.back().update(detection_json(group.detection));
  }
  for (const ForceFit& fit : summary.fits) fits.push_back(fit_json(fit));
  const double rate = pace.wall > 0.0 ? static_cast<double>(pace.runs_now) / pace.wall : 0.0;
  return json_text(Json{{"campaign", campaign.name},
                        {"runs", campaign.runs()},
                        {"failed", failed},
                        {"wall_s", pace.wall},
                        {"runs_per_s", rate},
                        {"groups", groups},
                        {"fits", fits},
                        {"fit_of_all", summary.fit_of_all ? fit_json(*summary.fit_of_all) : Json(nullptr)}});
}

}  // namespace flinch
