#include "experiments/campaign/run_result.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "diagrams/contact_control_settings.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/verdict/names_of_touched.h"
#include "experiments/verdict/verdict.h"
#include "experiments/verdict/verdict_output.h"
#include "plant/perturbed_robot.h"
#include "systems/config/parsed.h"
#include "systems/laws/safety_filter.h"
#include "systems/motion/constraint_settings.h"

namespace flinch {
namespace {

/// "leg2_link1" is a link1.
std::string kind_of(const std::string& body) {
  return body.starts_with("leg") ? body.substr(body.find('_') + 1) : body;
}

/// Limits are kept to this share.
constexpr double exactly = 1e-6;

bool exceeds_sigma_kappa(double measure, const ConstraintSettings& limits) {
  return measure > (1.0 + exactly) * limits.sigma_kappa.safety;
}
bool exceeds_sigma_sc(double measure, const ConstraintSettings& limits) {
  return measure < (1.0 - exactly) * limits.sigma_sc.safety;
}

/// Whether the limits that the robot keeps are no wider than the safety values.
bool keeps_safety_values(const SafetyFilterSettings& kept, const ConstraintSettings& limits) {
  return kept.limits.max_condition_number <= limits.sigma_kappa.safety &&
         kept.limits.workspace.min_self_collision_distance >= limits.sigma_sc.safety;
}

void note_constraints(const Verdict& verdict, const ContactControlSettings& control, RunResult& result) {
  const ConstraintSettings& limits = control.tasks.constraints;
  const bool from_the_start = control.limits.use == SafetyFilterSettings::Use::always;
  const auto& [sigma_kappa, sigma_sc] = from_the_start ? verdict.measures : verdict.measures_once_detected;
  result.self_contact = !verdict.self_contacts.empty();
  if (verdict.measures.sigma_kappa && verdict.measures.sigma_sc) {
    result.starts_inside = !exceeds_sigma_kappa(verdict.measures.sigma_kappa->first, limits) &&
                           !exceeds_sigma_sc(verdict.measures.sigma_sc->first, limits);
  }
  if (sigma_kappa) {
    result.sigma_kappa_least = sigma_kappa->least;
    result.sigma_kappa_most = sigma_kappa->most;
    result.sigma_kappa_last = sigma_kappa->last;
    result.violates_sigma_kappa = exceeds_sigma_kappa(sigma_kappa->most, limits);
  }
  if (sigma_sc) {
    result.sigma_sc_least = sigma_sc->least;
    result.sigma_sc_most = sigma_sc->most;
    result.sigma_sc_last = sigma_sc->last;
    const bool kappa_ends = sigma_kappa && sigma_kappa->last <= 1.05 * limits.sigma_kappa.safety;
    result.ends_inside = kappa_ends && sigma_sc->last >= limits.sigma_sc.safety - 0.005;
    result.violates_sigma_sc = exceeds_sigma_sc(sigma_sc->least, limits);
  }
}

std::string text_of(const std::string& value) { return value; }
std::string text_of(double value) { return exact_text(value); }
std::string text_of(bool value) { return value ? "1" : "0"; }
std::string text_of(std::integral auto value) { return std::to_string(value); }
template <class Value>
std::string text_of(const std::optional<Value>& value) {
  return value ? text_of(*value) : "";
}

bool parse(const std::string& text, std::string& value) {
  value = text;
  return true;
}
bool parse(const std::string& text, bool& value) {
  value = text == "1";
  return text == "0" || text == "1";
}
template <class Number>
requires std::is_arithmetic_v<Number>
bool parse(const std::string& text, Number& value) {
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && rest == end;
}
template <class Value>
bool parse(const std::string& text, std::optional<Value>& value) {
  value.reset();
  return text.empty() || parse(text, value.emplace());
}

/// Visits the columns of one estimator.
template <class Result, class Visit>
void estimator_columns(Result& result, Visit&& visit) {
  visit("detection_time_s", result.detection_time);
  visit("false_alarm", result.false_alarm);
  visit("contact_free_s", result.contact_free);
}

constexpr std::size_t columns_an_estimator = 3;
const std::string last_of_estimator = ".contact_free_s";
const std::string name_of_figures = "figures";  // the last column, where there is one

/// Visits all columns but those of estimators, in their order; `values` is visited between.
template <class Result, class Visit, class VisitValues>
void columns(Result& result, Visit&& visit, VisitValues&& visit_values) {
  visit("run", result.run);
  visit("point", result.point);
  visit("draw", result.draw);
  visit("seed", result.seed);
  visit("attempts", result.attempts);
  visit_values();
  visit("good", result.good);
  visit("fault", result.fault);
  visit("body", result.body);
  visit("removal_time_s", result.removal_time);
  visit("speed_m_per_s", result.speed);
  visit("peak_force_N", result.peak_force);
  visit("lasting_force_N", result.lasting_force);
  visit("over_limit_s", result.over_limit);
  visit("transient_limit_N", result.transient_limit);
  visit("quasi_static_limit_N", result.quasi_static_limit);
  visit("meant", result.meant);
  visit("law", result.law);
  visit("class_right", result.class_right);
  visit("sigma_kappa_least", result.sigma_kappa_least);
  visit("sigma_kappa_most", result.sigma_kappa_most);
  visit("sigma_kappa_last", result.sigma_kappa_last);
  visit("sigma_sc_least_m", result.sigma_sc_least);
  visit("sigma_sc_most_m", result.sigma_sc_most);
  visit("sigma_sc_last_m", result.sigma_sc_last);
  visit("starts_inside", result.starts_inside);
  visit("violates_sigma_kappa", result.violates_sigma_kappa);
  visit("violates_sigma_sc", result.violates_sigma_sc);
  visit("ends_inside", result.ends_inside);
  visit("self_contact", result.self_contact);
  visit("could_stop", result.could_stop);
  visit("drive_torque_most", result.largest_torque);
  visit("observer_error_force_N", result.observer_error_force);
  visit("observer_error_moment_Nm", result.observer_error_moment);
  visit("tracking_error_m", result.tracking_error);
  visit("simulated_s", result.simulated);
}

/// What each detector saw until something was touched, and of the first contact.
std::vector<EstimatorResult> results_by_estimator(const Verdict& verdict, std::optional<double> onset) {
  std::vector<EstimatorResult> results;
  for (std::size_t i = 0; i < verdict.first_detected.size(); ++i) {
    const DetectionBy& first = verdict.first_detected[i];
    EstimatorResult result{.name = first.estimator.empty() ? "followed" : first.estimator};
    const std::optional<double>& followed = verdict.first_detected.front().detected;
    result.contact_free = std::min(onset.value_or(verdict.simulated), followed.value_or(verdict.simulated));
    if (first.detected && *first.detected < onset.value_or(verdict.simulated) &&
        *first.detected <= result.contact_free) {
      result.false_alarm = true;
      result.contact_free = *first.detected;
    }
    if (onset) {
      const DetectionBy& by = verdict.contacts.front().detected_by[i];
      if (by.detected) result.detection_time = *by.detected - *onset;
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace

RunResult result_of(const CampaignRun& run, const Verdict& verdict) {
  RunResult result;
  result.run = run.number;
  result.point = run.point;
  result.draw = run.draw;
  result.seed = run.seed;
  result.attempts = run.attempts;
  result.values = run.values;
  if (run.tells_figures) {
    const SimulatedScenario& made = run.scenario;
    result.figures = verdict_json(
        verdict,
        {.seed = run.seed, .robot = perturbed_robot_values(made.perturbed_robot, *made.robot.robot)});
  }
  result.good = verdict.good();
  result.fault = verdict.fault;
  result.simulated = verdict.simulated;
  result.transient_limit = verdict.limits.transient;
  result.quasi_static_limit = verdict.limits.quasi_static;
  result.largest_torque = verdict.largest_torque;
  result.observer_error_force = verdict.max_observer_error_force;
  result.observer_error_moment = verdict.max_observer_error_moment;
  result.tracking_error = verdict.max_tracking_error;
  const ContactControlSettings& control = run.scenario.control;
  result.law = followed_name(control.stages.reaction_laws);
  result.meant = kind_of(run.scenario.expected.contact.value_or(""));
  note_constraints(verdict, control, result);
  for (const ContactVerdict& contact : verdict.contacts) result.over_limit += contact.over_limit;
  const std::optional<double> onset =
      verdict.contacts.empty() ? std::nullopt : std::optional(verdict.contacts.front().onset);
  result.estimators = results_by_estimator(verdict, onset);
  if (!verdict.contacts.empty()) {
    const ContactVerdict& first = verdict.contacts.front();
    result.body = first.is_push ? "push" : kind_of(first.body);
    if (keeps_safety_values(control.limits, control.tasks.constraints)) result.could_stop = first.could_stop;
    if (first.removed) result.removal_time = *first.removed - first.onset;
    result.speed = first.speed;
    result.peak_force = first.peak_force;
    result.lasting_force = first.lasting_force;
    const bool is_known = !first.classified.empty() && !first.body.empty() && !first.is_push;
    if (is_known) result.class_right = names_body(first.classified, first.body);
  }
  return result;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csv_header(const RunResult& result) {
  std::string line;
  const auto add = [&line](const std::string& name) { line += (line.empty() ? "" : ",") + csv_cell(name); };
  columns(
      result, [&](const char* name, const auto&) { add(name); },
      [&] {
        for (const auto& [key, value] : result.values) add(key);
      });
  for (const EstimatorResult& estimator : result.estimators) {
    estimator_columns(estimator, [&](const char* name, const auto&) { add(estimator.name + "." + name); });
  }
  if (!result.figures.empty()) add(name_of_figures);
  return line;
}

std::string csv_row(const RunResult& result) {
  std::string line;
  bool is_first = true;
  const auto add = [&](const std::string& text) {
    if (!std::exchange(is_first, false)) line += ',';
    line += csv_cell(text);
  };
  columns(
      result, [&](const char*, const auto& value) { add(text_of(value)); },
      [&] {
        for (const auto& [key, value] : result.values) add(value);
      });
  for (const EstimatorResult& estimator : result.estimators) {
    estimator_columns(estimator, [&](const char*, const auto& value) { add(text_of(value)); });
  }
  if (!result.figures.empty()) add(result.figures);
  return line;
}

std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted) {
      if (c != '"') {
        cells.back() += c;
      } else if (i + 1 < line.size() && line[i + 1] == '"') {
        cells.back() += line[++i];
      } else {
        quoted = false;
      }
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return quoted ? std::vector<std::string>{} : cells;
}

std::optional<RunResult> parse_csv_row(const std::vector<std::string>& names, const std::string& row) {
  static const std::size_t others = csv_cells(csv_header(RunResult())).size();
  const std::vector<std::string> cells = csv_cells(row);
  if (cells.size() != names.size()) return std::nullopt;
  RunResult result;
  std::size_t end = names.size();  // of all but the estimators
  if (end > others && names.back() == name_of_figures) result.figures = cells[--end];
  for (; end >= columns_an_estimator && names[end - 1].ends_with(last_of_estimator);
       end -= columns_an_estimator) {
    std::string name = names[end - 1].substr(0, names[end - 1].size() - last_of_estimator.size());
    result.estimators.push_back({.name = std::move(name)});
  }
  if (end < others) return std::nullopt;
  std::reverse(result.estimators.begin(), result.estimators.end());
  std::size_t next = 0;
  bool is_whole = true;
  const auto take = [&](const char*, auto& value) { is_whole = parse(cells[next++], value) && is_whole; };
  columns(result, take, [&] {
    const std::size_t end_of_values = next + end - others;
    for (; next < end_of_values; ++next) result.values.emplace_back(names[next], cells[next]);
  });
  for (EstimatorResult& estimator : result.estimators) estimator_columns(estimator, take);
  return is_whole ? std::optional(result) : std::nullopt;
}

}  // namespace flinch
