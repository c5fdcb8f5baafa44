#include "experiments/campaign/campaign_page.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/exact_bounds.h"
#include "experiments/campaign/page/campaign_page_template.h"
#include "experiments/campaign/reaction_summary.h"
#include "experiments/campaign/run_result.h"
#include "experiments/report/script_data.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/result_file.h"
#include "systems/motion/constraint_settings.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t runs_of_a_sort = 12;  // to look at

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json known(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

/// False alarms of an estimator at one place in the grid, in all scenarios and whatever was touched then.
struct Alarms {
  std::size_t count = 0;
  double hours = 0.0;

  double rate() const { return hours > 0.0 ? static_cast<double>(count) / hours : 0.0; }
};

using Place = std::vector<std::pair<std::string, std::string>>;
using AlarmsAt = std::map<std::pair<Place, std::string>, Alarms>;

std::pair<Place, std::string> in_any_scenario(const CampaignGroup& group) {
  Place place = group.at;
  std::erase_if(place, [](const auto& entry) { return entry.first == "scenario"; });
  return {std::move(place), group.estimator};
}

AlarmsAt alarms_of(const std::vector<CampaignGroup>& groups) {
  AlarmsAt alarms;
  for (const CampaignGroup& group : groups) {
    Alarms& here = alarms[in_any_scenario(group)];
    here.count += group.false_alarms;
    here.hours += group.contact_free / 3600.0;
  }
  return alarms;
}

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
          {"false_alarms", group.false_alarms},
          {"contact_free_h", group.contact_free / 3600.0},
          {"rate", group.false_alarms_per_hour},
          {"rate_at_most", finite(group.false_alarms_per_hour_at_most)},
          {"alarms", alarms.count},
          {"alarm_rate", alarms.rate()},
          {"alarm_rate_at_most", finite(upper_rate(alarms.count, alarms.hours))}};
}

/// Why one looks at a run, and how badly one must: faults first, then false alarms, missed and slow contacts,
/// of the detector that the robot followed.
struct Reason {
  std::string why;
  double weight = 0.0;
};

Reason reason_for(const RunResult& result, double missed_after) {
  constexpr double fault = 4.0, false_alarm = 3.0, missed = 2.0;  // seconds are less
  if (!result.fault.empty()) return {"fault: " + result.fault, fault};
  const EstimatorResult& followed = result.estimators.front();
  if (followed.false_alarm) return {"false alarm", false_alarm};
  if (result.body == "none") return {};
  if (!followed.detection_time || *followed.detection_time > missed_after) return {"missed", missed};
  return {"slow", *followed.detection_time};
}

/// Pairs of key and value.
Json pairs(const Place& values) {
  Json list = Json::array();
  for (const auto& [key, value] : values) list.push_back(Json::array({key, value}));
  return list;
}

Json drawn_for(const Campaign& campaign, const RunResult& result) {
  const std::size_t first = campaign.grid.size() + (campaign.scenarios.size() > 1 ? 1U : 0U);
  return pairs({result.values.begin() + static_cast<std::ptrdiff_t>(first), result.values.end()});
}

/// The worst runs of each sort, the worst first.
Json runs_to_look_at(const Campaign& campaign, const std::vector<RunResult>& results, std::size_t places) {
  std::vector<std::pair<Reason, const RunResult*>> worst;
  for (const RunResult& result : results) {
    if (Reason reason = reason_for(result, campaign.missed_after); reason.weight > 0.0)
      worst.emplace_back(std::move(reason), &result);
  }
  std::stable_sort(worst.begin(), worst.end(),
                   [](const auto& a, const auto& b) { return a.first.weight > b.first.weight; });
  std::map<double, std::size_t> taken;  // by sort: of slow ones, those below a second
  Json list = Json::array();
  for (const auto& [reason, result] : worst) {
    if (taken[std::max(1.0, reason.weight)]++ >= runs_of_a_sort) continue;
    list.push_back({{"run", result->run},
                    {"why", reason.why},
                    {"point", result->point % places},
                    {"body", result->body},
                    {"time", known(result->estimators.front().detection_time)},
                    {"speed", known(result->speed)},
                    {"drawn", drawn_for(campaign, *result)}});
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
          {"detection", known(detection)},
          {"reaction", reaction},
          {"kappa", known(result.sigma_kappa_most)},
          {"sc", known(result.sigma_sc_least)},
          {"kappa_end", known(result.sigma_kappa_last)},
          {"sc_end", known(result.sigma_sc_last)}};
}

/// The limits are those of the first run.
Json reaction_dots(const Campaign& campaign, const std::vector<RunResult>& results) {
  Json runs = Json::array(), fits = Json::array();
  for (const RunResult& result : results) runs.push_back(reaction_of(result));
  for (const ForceFit& fit : reactions_of(results).fits) {
    fits.push_back(
        {{"body", fit.body}, {"slope", fit.slope}, {"intercept", fit.intercept}, {"pearson", fit.pearson}});
  }
  const SimulatedScenario scenario = draw_run(campaign, 0).scenario;
  const ConstraintSettings& constraints = scenario.control.tasks.constraints;
  return {{"runs", runs},
          {"fits", fits},
          {"limits",
           {{"transient", scenario.force_limits.transient},
            {"quasi_static", scenario.force_limits.quasi_static},
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

std::string campaign_page(const Campaign& campaign, const std::vector<RunResult>& results,
                          const std::vector<CampaignGroup>& groups, const std::string& call) {
  const std::size_t places =
      campaign.grid_points() / (campaign.contact ? campaign.contact->bodies.size() : 1);
  const AlarmsAt alarms = alarms_of(groups);
  Json list = Json::array();
  Json points(places, Json::array());
  std::vector<std::string> estimators;
  for (const CampaignGroup& group : groups) {
    points[group.place] = pairs(place_of(group, campaign));
    add_new(group.estimator, estimators);
    list.push_back(group_json(group, alarms.at(in_any_scenario(group))));
  }
  std::size_t faults = 0;
  double simulated = 0.0;
  for (const RunResult& result : results) {
    faults += result.fault.empty() ? 0U : 1U;
    simulated += result.simulated;
  }
  const Json provenance = pairs({{"Version", "flinch " FLINCH_VERSION},
                                 {"File", campaign.file.filename().string()},
                                 {"Seed", std::to_string(campaign.seed)},
                                 {"Call", call}});
  Json data = {{"title", campaign.title},
               {"description", campaign.description},
               {"runs", campaign.runs()},
               {"draws", campaign.draws},
               {"faults", faults},
               {"simulated_h", simulated / 3600.0},
               {"missed_after", campaign.missed_after},
               {"points", points},
               {"estimators", estimators},
               {"groups", list},
               {"look", runs_to_look_at(campaign, results, places)},
               {"call", call},
               {"provenance", provenance},
               {"texts", texts_of(campaign)}};
  if (campaign.summary == Campaign::Summary::reactions) data["reactions"] = reaction_dots(campaign, results);
  return std::string(campaign_page_template_before_data) + inside_script(json_text(data)) +
         std::string(campaign_page_template_after_data);
}

void write_campaign_page(const Campaign& campaign, const std::vector<RunResult>& results,
                         const std::vector<CampaignGroup>& groups, const std::string& call,
                         const std::filesystem::path& file) {
  write_result(file, campaign_page(campaign, results, groups, call));
}

}  // namespace flinch
