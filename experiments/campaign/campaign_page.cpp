#include "experiments/campaign/campaign_page.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_results.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/counted_alarms.h"
#include "experiments/campaign/exact_bounds.h"
#include "experiments/campaign/page/campaign_page_template.h"
#include "experiments/campaign/reaction_summary.h"
#include "experiments/campaign/run_result.h"
#include "experiments/report/script_data.h"
#include "experiments/verdict/body_regions.h"
#include "experiments/verdict/verdict.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/result_file.h"
#include "systems/motion/constraint_settings.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t runs_of_a_sort = 12;  // to look at

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json known(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json group_json(const CampaignGroup& group, const Alarms& alarms) {
  Json quantiles = Json::array();
  for (const auto& time : group.quantiles) quantiles.push_back(known(time));
  return {{"point", group.place},
          {"estimator", group.estimator},
          {"body", group.body},
          {"n", group.n},
          {"faults", group.faults},
          {"contacts", group.contacts},
          {"missed", group.missed},
          {"missed_at_most", known(group.missed_at_most)},
          {"quantiles", quantiles},
          {"median_within", {known(group.median_within[0]), known(group.median_within[1])}},
          {"p90_within", {known(group.p90_within[0]), known(group.p90_within[1])}},
          {"false_alarms", group.false_alarms},
          {"contact_free_h", group.contact_free / 3600.0},
          {"rate", group.false_alarms_per_hour},
          {"rate_at_most", finite(group.false_alarms_per_hour_at_most)},
          {"alarms", alarms.count},
          {"alarm_hours", alarms.hours},
          {"alarm_rate", alarms.rate()},
          {"alarm_rate_at_most", finite(garwood_upper(alarms.count, alarms.hours))},
          {"over_limit", group.longest_over_limit}};
}

/// Why one looks at a run: the worst sort first, of the detector that the robot followed.
struct Reason {
  enum class Sort { fault, false_alarm, missed, slow };
  Sort sort;
  std::string why;
  double time = 0.0;  ///< of slow contacts, until they were detected [s]
};

std::optional<Reason> reason_for(const RunResult& result, double missed_after) {
  if (!result.fault.empty()) return Reason{Reason::Sort::fault, "fault: " + result.fault};
  const EstimatorResult& followed = result.estimators.front();
  if (followed.false_alarm) return Reason{Reason::Sort::false_alarm, "false alarm"};
  if (result.body == "none") return std::nullopt;
  const std::optional<double>& time = followed.detection_time;
  if (!time || *time > missed_after) return Reason{Reason::Sort::missed, "missed"};
  return *time > 0.0 ? std::optional(Reason{Reason::Sort::slow, "slow", *time}) : std::nullopt;
}

/// Pairs of key and value.
Json pairs(const std::vector<std::pair<std::string, std::string>>& values) {
  Json list = Json::array();
  for (const auto& [key, value] : values) list.push_back(Json::array({key, value}));
  return list;
}

Json drawn_for(const Campaign& campaign, const RunResult& result) {
  const std::size_t first = campaign.grid.size() + (campaign.scenarios.size() > 1 ? 1U : 0U);
  return pairs({result.values.begin() + static_cast<std::ptrdiff_t>(first), result.values.end()});
}

/// The worst runs of each sort, the worst first.
Json runs_to_look_at(const Campaign& campaign, const CampaignResults& results, std::size_t places) {
  std::map<Reason::Sort, std::vector<std::pair<Reason, RunResult>>> worst;
  for (const RunResult& result : results) {
    std::optional<Reason> reason = reason_for(result, campaign.missed_after);
    if (!reason) continue;
    auto& runs = worst[reason->sort];
    const auto after = std::find_if(runs.begin(), runs.end(),
                                    [&](const auto& run) { return run.first.time < reason->time; });
    if (after == runs.end() && runs.size() == runs_of_a_sort) continue;
    runs.insert(after, {std::move(*reason), result});
    if (runs.size() > runs_of_a_sort) runs.pop_back();
  }
  Json list = Json::array();
  for (const auto& [sort, runs] : worst) {
    for (const auto& [reason, result] : runs) {
      list.push_back({{"run", result.run},
                      {"why", reason.why},
                      {"point", result.point % places},
                      {"body", result.body},
                      {"time", known(result.estimators.front().detection_time)},
                      {"speed", known(result.speed)},
                      {"drawn", drawn_for(campaign, result)}});
    }
  }
  return list;
}

/// A dot of the pictures.
Json reaction_of(const RunResult& result) {
  const std::optional<double> detection = result.estimators.front().detection_time;
  Json reaction = nullptr;
  if (detection && result.removal_time) reaction = *result.removal_time - *detection;
  return {{"run", result.run},
          {"level", level_of(result.law)},
          {"body", body_of(result)},
          {"speed", known(result.speed)},
          {"peak", known(result.peak_force)},
          {"lasting", known(result.lasting_force)},
          {"duration", known(result.removal_time)},
          {"detection", known(detection)},
          {"reaction", reaction},
          {"kappa", known(result.sigma_kappa_most)},
          {"sc", known(result.sigma_sc_least)},
          {"kappa_best", known(result.sigma_kappa_least)},
          {"sc_best", known(result.sigma_sc_most)},
          {"kappa_end", known(result.sigma_kappa_last)},
          {"sc_end", known(result.sigma_sc_last)}};
}

Json fit_of(const ForceFit& fit) {
  return {{"body", fit.body},
          {"n", fit.n},
          {"slope", fit.slope},
          {"intercept", fit.intercept},
          {"pearson", fit.pearson},
          {"speed_at_transient", known(fit.speed_at_transient)},
          {"speed_at_quasi_static", known(fit.speed_at_quasi_static)}};
}

/// The limits are those of the first run.
Json reaction_dots(const Campaign& campaign, const CampaignResults& results) {
  Json runs = Json::array(), fits = Json::array();
  for (const RunResult& result : results) runs.push_back(reaction_of(result));
  const ReactionSummary summary = reactions_of(results, campaign.missed_after);
  for (const ForceFit& fit : summary.fits) fits.push_back(fit_of(fit));
  const SimulatedScenario scenario = draw_run(campaign, 0).scenario;
  const ConstraintSettings& constraints = scenario.control.tasks.constraints;
  const ForceLimits& forces = scenario.force_limits;
  return {{"runs", runs},
          {"fits", fits},
          {"fit_of_all", summary.fit_of_all ? fit_of(*summary.fit_of_all) : Json(nullptr)},
          {"limits",
           {{"region", region_of(forces)},
            {"transient", forces.transient},
            {"transient_source", forces.transient_source},
            {"transient_duration", forces.transient_duration},
            {"quasi_static", forces.quasi_static},
            {"quasi_static_source", forces.quasi_static_source},
            {"sigma_kappa", constraints.sigma_kappa.safety},
            {"sigma_sc", constraints.sigma_sc.safety}}}};
}

/// Names in the order in which they first come.
void add_new(const std::string& name, std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

Json texts_of(const Campaign& campaign) {
  Json texts = Json::array();
  for (std::size_t i = 0; i < campaign.scenarios.size(); ++i) {
    texts.push_back({{"title", "Scenario " + campaign.scenarios[i].filename().string()},
                     {"text", campaign.scenario_texts[i]}});
  }
  return texts;
}

}  // namespace

std::string campaign_page(const Campaign& campaign, const CampaignResults& results,
                          const std::vector<CampaignGroup>& groups, const CountedAlarms& alarms,
                          const std::string& call) {
  const std::size_t places =
      campaign.grid_points() / (campaign.contact ? campaign.contact->bodies.size() : 1);
  Json list = Json::array();
  Json points(places, Json::array());
  std::vector<std::string> estimators;
  for (const CampaignGroup& group : groups) {
    points[group.place] = pairs(place_of(group, campaign));
    add_new(group.estimator, estimators);
    list.push_back(group_json(group, alarms.of(group)));
  }
  double simulated = 0.0;
  for (const RunResult& result : results) simulated += result.simulated;
  const Json provenance = pairs({{"Version", "flinch " FLINCH_VERSION},
                                 {"File", campaign.file.filename().string()},
                                 {"Seed", std::to_string(campaign.seed)},
                                 {"Call", call}});
  Json data = {{"title", campaign.title},
               {"description", campaign.description},
               {"runs", campaign.runs()},
               {"draws", campaign.draws},
               {"faults", faulted_runs(results)},
               {"simulated_h", simulated / 3600.0},
               {"missed_after", campaign.missed_after},
               {"points", points},
               {"estimators", estimators},
               {"groups", list},
               {"alarm_table", alarms.table().string()},
               {"look", runs_to_look_at(campaign, results, places)},
               {"call", call},
               {"provenance", provenance},
               {"texts", texts_of(campaign)}};
  if (campaign.summary == Campaign::Summary::reactions) data["reactions"] = reaction_dots(campaign, results);
  return std::string(campaign_page_template_before_data) + inside_script(json_text(data)) +
         std::string(campaign_page_template_after_data);
}

void write_campaign_page(const Campaign& campaign, const CampaignResults& results,
                         const std::vector<CampaignGroup>& groups, const CountedAlarms& alarms,
                         const std::string& call, const std::filesystem::path& file) {
  write_result(file, campaign_page(campaign, results, groups, alarms, call));
}

}  // namespace flinch
