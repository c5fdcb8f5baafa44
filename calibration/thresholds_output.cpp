#include "calibration/thresholds_output.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "experiments/scenario/estimate_settings.h"
#include "experiments/scenario/scenario.h"
#include "systems/config/robot_file.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

constexpr double largest_variation = 0.3;  // up to which thresholds keep the rate, see `MahalanobisTail`

Json json_of(const CalibratedThreshold& threshold) {
  return {{"value", threshold.value},
          {"best_guess", threshold.best_guess},
          {"largest", threshold.largest},
          {"papers_rule", threshold.papers_rule}};
}

Json json_of(const std::vector<CalibratedThreshold>& thresholds) {
  Json list = Json::array();
  for (const CalibratedThreshold& threshold : thresholds) list.push_back(json_of(threshold));
  return list;
}

std::string row(const std::string& estimator, const char* quantity, const CalibratedThreshold& threshold,
                const char* unit) {
  return fmt::format("{:<28} {:<8} {:>9.3g} {:>9.3g} {:>9.3g} {:>9.3g}  {}\n", estimator, quantity,
                     threshold.value, threshold.best_guess, threshold.largest, threshold.papers_rule, unit);
}

/// Of forces, or of moments, by component.
std::vector<CalibratedThreshold> part(const EstimatorThresholds& of, const ConfigurationSpace& space,
                                      bool forces) {
  const auto middle = of.components.begin() + (of.components.empty() ? 0 : space.translations());
  return forces ? std::vector(of.components.begin(), middle) : std::vector(middle, of.components.end());
}

std::string rows(const EstimatorThresholds& of, const ConfigurationSpace& space) {
  constexpr std::string_view axes = "xyz";
  std::string text;
  const auto add = [&](const char* quantity, const CalibratedThreshold& whole, bool forces,
                       const char* unit) {
    const std::string& name = text.empty() ? of.estimator : "";
    const std::vector<CalibratedThreshold> each = part(of, space, forces);
    if (each.empty()) text += row(name, quantity, whole, unit);
    const std::size_t first = each.size() == 1 ? axes.size() - 1 : 0;  // a planar robot turns about z
    for (std::size_t i = 0; i < each.size(); ++i)
      text +=
          row(i == 0 ? name : "", (std::string(quantity) + " " + axes.at(first + i)).c_str(), each[i], unit);
  };
  add("force", of.force, true, "N");
  if (of.moment.value > 0.0) add("moment", of.moment, false, "Nm");
  return text;
}

/// One for all components, or one of each.
std::vector<double> values_of(const CalibratedThreshold& whole,
                              const std::vector<CalibratedThreshold>& each) {
  if (each.empty()) return {whole.value};
  std::vector<double> values;
  for (const CalibratedThreshold& of : each) values.push_back(of.value);
  return values;
}

std::vector<double> values_of(const JointVector& of) { return {of.begin(), of.end()}; }

/// As the value of a key.
std::string text_of(const std::vector<double>& values) {
  if (values.size() == 1) return fmt::format("{:.4g}", values.front());
  return fmt::format("[{:.4g}]", fmt::join(values, ", "));
}

/// What recordings without an alarm prove by themselves, at most [1/h]: Garwood (1936) for none.
double proven_rate(double seconds, const ThresholdGoal& goal) {
  return -std::log1p(-goal.confidence) / (seconds / 3600.0);
}

double seconds(std::size_t stretches, const ThresholdGoal& goal) {
  return static_cast<double>(stretches) * to_seconds(goal.stretch);
}

/// One part of a residual, by name.
struct NamedDistance {
  const char* name;
  const CalibratedDistance& distance;
};

std::array<NamedDistance, 3> parts(const CalibratedResidual& residual) {
  return {{{"level", residual.level}, {"change", residual.change}, {"smoothed", residual.smoothed}}};
}

std::string residuals_table(const ThresholdFindings& found) {
  std::string text = fmt::format(
      "\nfused detector, all of it together; deviations of the errors by cause, noise and rest in {}, lag in "
      "ms, acceleration in {}\n{:<22} {:<8} {:>9} {:>9} {:>9} {:>9} {:>7} {:>7} {:>7} {:>7} {:>8} {:>7} "
      "{:>7} {:>7} {:>7}\n",
      found.drives_turn ? "Nm" : "N", found.drives_turn ? "rad/s^2" : "m/s^2", "residual", "of", "threshold",
      "guess", "largest", "variation", "noise", "speed", "load", "torque", "friction", "lag", "rest",
      "accel.", "turning");
  for (const CalibratedResidual& residual : found.residuals) {
    for (const auto& [part, of] : parts(residual)) {
      text += fmt::format(
          "{:<22} {:<8} {:>9.3g} {:>9.3g} {:>9.3g} {:>9.3f} {:>7.3f} {:>7.3f} {:>7.3f} {:>7.3f} {:>8.3f} "
          "{:>7.3f} {:>7.3f} {:>7.3f} {:>7.3f}\n",
          residual.estimator, part, of.threshold.value, of.threshold.best_guess, of.threshold.largest,
          of.variation, of.errors.noise, of.errors.speed, of.errors.load, of.errors.torque,
          of.errors.friction, 1e3 * of.errors.lag, of.errors.rest, of.errors.acceleration, of.errors.turning);
    }
  }
  return text;
}

std::string onset_row(const CalibratedResidual& residual) {
  if (!residual.onset) return "";
  const CalibratedOnset& onset = *residual.onset;
  std::string row = fmt::format("{:<22} {:<8} {:>9.3g} {:>9.3g} {:>9.3g} {:>10.3f}", residual.estimator,
                                "onset", onset.threshold.value, onset.threshold.best_guess,
                                onset.threshold.largest, onset.course.innovation);
  for (const double a : onset.course.prediction) row += fmt::format(" {:>7.3f}", a);
  return row + "\n";
}

/// By the likelihood ratio of onsets, in place of the changes.
std::string onsets_table(const ThresholdFindings& found) {
  std::string text = fmt::format(
      "\nthe same by rule: likelihood_ratio, onsets in place of changes; how these are told from the {} "
      "before\n"
      "{:<22} {:<8} {:>9} {:>9} {:>9} {:>10}",
      AutoregressiveError::order, "residual", "of", "threshold", "guess", "largest", "innovation");
  for (int j = 1; j <= AutoregressiveError::order; ++j) text += fmt::format(" {:>7}", fmt::format("a_{}", j));
  text += "\n";
  for (const CalibratedResidual& residual : found.residuals) text += onset_row(residual);
  return text;
}

/// A size of errors as files have it: 0 where it is too small to compute with.
double computable(double size) { return size < 1e-20 ? 0.0 : size; }

std::string residuals_yaml(const ThresholdFindings& found) {
  std::string text = fmt::format(
      "  fused_detector:\n    tracking_per_s: {:.4g}\n    smoothing_per_s: {:.4g}\n    residuals:\n",
      found.tracking.rate, found.tracking.smoothing);
  for (const CalibratedResidual& residual : found.residuals) {
    text += "      - estimator: " + residual.estimator + "\n";
    for (const auto& [part, of] : parts(residual)) {
      text += fmt::format("        {}: {{threshold: {:.4g}, noise_{}: {:.4g}, speed_{}: {:.4g}", part,
                          of.threshold.value, found.drives_turn ? "Nm" : "N", of.errors.noise,
                          found.drives_turn ? "Nms_per_rad" : "Ns_per_m", computable(of.errors.speed));
      text += fmt::format(
          ", load: {:.4g}, torque: {:.4g}, friction: {:.4g}, lag_ms: {:.4g}, rest_{}: {:.4g}, "
          "acceleration_{}: {:.4g}, turning: {:.4g}}}\n",
          computable(of.errors.load), computable(of.errors.torque), computable(of.errors.friction),
          1e3 * computable(of.errors.lag), found.drives_turn ? "Nm" : "N", computable(of.errors.rest),
          found.drives_turn ? "rad_per_s2" : "m_per_s2", computable(of.errors.acceleration),
          computable(of.errors.turning));
    }
    if (!residual.onset) continue;
    const CalibratedOnset& onset = *residual.onset;
    text +=
        fmt::format("        onset: {{threshold: {:.4g}, innovation: {:.4g}, prediction: [{:.4g}]}}\n",
                    onset.threshold.value, onset.course.innovation, fmt::join(onset.course.prediction, ", "));
  }
  return text;
}

std::string listed(const std::vector<CalibrationSource>& files) {
  std::string text;
  for (const CalibrationSource& of : files)
    text += fmt::format("#   {}, sha256 {}\n", comment_text(of.file), of.sha256);
  return text;
}

/// What the thresholds keep, and by which robots; `begin` begins each line.
std::string promise(const ThresholdFindings& found, const char* begin) {
  const ThresholdGoal& goal = found.goal;
  std::string text = fmt::format(
      "{}for {} false alarms an hour of each estimator, kept with a confidence of {:.0f} % in\n"
      "{}motion like that of the recordings\n",
      begin, goal.false_alarms_per_hour, 100.0 * goal.confidence, begin);
  if (found.residuals.empty()) return text;
  if (goal.one_robot) {
    return text + begin + "fused detector: for the one robot that was recorded (--one-robot)\n";
  }
  const std::size_t recordings = found.recordings.size();
  if (recordings == 1) {
    return text + begin +
           "fused detector: one recording does not tell how robots differ; the longest tail is taken\n";
  }
  return text + fmt::format(
                    "{}fused detector: for robots that differ as those of the {} recordings; how far they "
                    "differ, few\n"
                    "{}recordings tell only roughly\n",
                    begin, recordings, begin);
}

/// How the thresholds were found, as lines of comment.
std::string provenance(const ThresholdFindings& found) {
  const ThresholdGoal& goal = found.goal;
  std::string text = "# Thresholds made by flinch " FLINCH_VERSION ":\n" + promise(found, "#   ");
  if (!found.with.empty()) text += "# Played again with\n" + listed(found.with);
  text += fmt::format("# Largest of each, and {:.3g} x that, [RAL25] V-C:\n", goal.safety_factor);
  for (const EstimatorThresholds& of : found.estimators) {
    text += fmt::format("#   {}, {:.1f} s: {:.4g} N, {:.4g} N", of.estimator, seconds(of.stretches, goal),
                        of.force.largest, of.force.papers_rule);
    if (of.moment.value > 0.0)
      text += fmt::format("; {:.4g} Nm, {:.4g} Nm", of.moment.largest, of.moment.papers_rule);
    text += "\n";
  }
  for (const CalibratedResidual& residual : found.residuals) {
    for (const auto& [part, of] : parts(residual))
      text += fmt::format("#   {} of the fused detector, {}, {:.1f} s: {:.4g}\n", part, residual.estimator,
                          seconds(residual.stretches, goal), of.threshold.largest);
    if (!residual.onset) continue;
    text += fmt::format("#   onset of the fused detector, {}, {:.1f} s: {:.4g}\n", residual.estimator,
                        seconds(residual.stretches, goal), residual.onset->threshold.largest);
  }
  return text;
}

Json json_of(const CalibratedDistance& of) {
  return {{"value", of.threshold.value},     {"best_guess", of.threshold.best_guess},
          {"largest", of.threshold.largest}, {"noise", of.errors.noise},
          {"speed", of.errors.speed},        {"load", of.errors.load},
          {"torque", of.errors.torque},      {"friction", of.errors.friction},
          {"lag_s", of.errors.lag},          {"rest", of.errors.rest},
          {"variation", of.variation},       {"acceleration", of.errors.acceleration},
          {"turning", of.errors.turning},    {"between_robots", of.between_robots}};
}

Json json_of(const CalibratedOnset& of) {
  return {{"value", of.threshold.value},
          {"best_guess", of.threshold.best_guess},
          {"largest", of.threshold.largest},
          {"innovation", of.course.innovation},
          {"prediction", of.course.prediction}};
}

}  // namespace

void note_robot(const std::vector<Scenario>& scenarios, ThresholdFindings& found) {
  const Scenario& first = scenarios.front();
  const JointVector& constant = first.control.drive_torque.torque_constant;
  const auto all = [&](const auto& agrees) {
    return std::all_of(scenarios.begin(), scenarios.end(), agrees);
  };
  found.space = first.robot.robot->space();
  found.drives_turn = first.robot.robot->drive_kind(0) == DriveKind::revolute;
  if (all([&](const Scenario& other) { return other.robot_text == first.robot_text; }))
    found.robot = {first.robot_file.string(), calibrated_robot_hash(first.robot_text)};
  const auto has_same = [&](const Scenario& other) {
    const JointVector& its = other.control.drive_torque.torque_constant;
    return its.size() == constant.size() && its == constant;
  };
  if (!all(has_same)) return;
  for (int i = 0; i < static_cast<int>(constant.size()); ++i) {
    found.assumed.push_back({.name = drive_constant_key(*first.robot.robot, i),
                             .value = constant[i],
                             .unit = found.drives_turn ? "Nm/A" : "N/A"});
  }
}

void note_settings(const std::vector<Scenario>& scenarios, ThresholdFindings& found) {
  std::map<std::string, std::pair<std::string, std::size_t>> first;  // value of a key, and its recording
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    for (const ReadValue& setting : estimate_settings(scenarios[i])) {
      const auto [known, is_new] = first.emplace(setting.key, std::pair(setting.value, i));
      const auto& [value, recording] = known->second;
      if (is_new) found.settings.push_back(setting);
      if (value == setting.value) continue;
      problems.push_back(found.recordings[i].file + ": " + setting.key + " was " + setting.value + ", and " +
                         value + " in " + found.recordings[recording].file +
                         "; thresholds hold for one of them: calibrate from recordings that agree");
    }
  }
  throw_if_any(std::move(problems));
}

std::vector<std::string> warnings(const ThresholdFindings& found) {
  std::vector<std::string> all = found.warnings;
  for (const EstimatorThresholds& of : found.estimators) {
    if (of.stretches >= few_stretches) continue;
    all.push_back(
        fmt::format("{}: {:.1f} s of motion are few, so its threshold is {:.2g} times what is likely; record "
                    "{:.0f} s or more",
                    of.estimator, seconds(of.stretches, found.goal), of.force.value / of.force.best_guess,
                    seconds(few_stretches, found.goal)));
  }
  for (const CalibratedResidual& of : found.residuals) {
    double variation = 0.0, of_one = 0.0;
    for (const CalibratedDistance* part : {&of.level, &of.change, &of.smoothed}) {
      variation = std::max(variation, part->variation);
      of_one = std::max(of_one, (1.0 + part->variation) / (1.0 + part->between_robots) - 1.0);
    }
    if (variation <= largest_variation) continue;
    const char* const why =
        of_one <= largest_variation
            ? "the robots or their loads differ by so much: calibrate their dynamics, or thresholds for each"
            : "see whether the robot failed or was touched in these recordings, or record longer";
    all.push_back(
        fmt::format("{}: the variance of its errors varies by {:.2g} beside what is expected, and thresholds "
                    "keep the rate up to {}; {}",
                    of.estimator, variation, largest_variation, why));
  }
  if (found.residuals.empty() || found.goal.one_robot || found.recordings.size() > 1) return all;
  all.push_back(
      "one recording does not tell how robots differ, so the longest tail is taken for the fused detector; "
      "add recordings of other robots, or say --one-robot where its thresholds shall serve this one");
  return all;
}

std::vector<double> force_values(const EstimatorThresholds& of, const ConfigurationSpace& space) {
  return values_of(of.force, part(of, space, true));
}

std::vector<double> moment_values(const EstimatorThresholds& of, const ConfigurationSpace& space) {
  if (!(of.moment.value > 0.0)) return {};
  return values_of(of.moment, part(of, space, false));
}

std::string thresholds_table(const ThresholdFindings& found) {
  const ThresholdGoal& goal = found.goal;
  std::string text = promise(found, "") + "\n";
  text += fmt::format("{:<28} {:<8} {:>9} {:>9} {:>9} {:>9}\n", "estimator", "of", "threshold", "guess",
                      "largest", fmt::format("{:.3g} x max", goal.safety_factor));
  for (const EstimatorThresholds& of : found.estimators) {
    text += rows(of, found.space);
  }
  if (!found.residuals.empty()) text += residuals_table(found) + onsets_table(found);
  if (found.drive_deviations.size() > 0) {
    text += fmt::format("\nwrench of classifiers and locators: deviation at each drive {} {}\n",
                        text_of(values_of(found.drive_deviations)), found.drives_turn ? "Nm" : "N");
  }
  if (!found.estimators.empty()) {
    const double recorded = seconds(found.estimators.front().stretches, goal);
    text += fmt::format(
        "\nfrom {:.1f} s of motion without contact, in stretches of {} s; without an alarm they prove by "
        "themselves\nat most {:.3g} an hour, the rest is the course of the tail\n",
        recorded, to_seconds(goal.stretch), proven_rate(recorded, goal));
  }
  return text;
}

std::string thresholds_json(const ThresholdFindings& found) {
  const ThresholdGoal& goal = found.goal;
  Json list = Json::array();
  for (const EstimatorThresholds& of : found.estimators) {
    list.push_back({{"estimator", of.estimator},
                    {"contact_free_s", seconds(of.stretches, goal)},
                    {"proven_false_alarms_at_most_per_h", proven_rate(seconds(of.stretches, goal), goal)},
                    {"force_N", json_of(of.force)},
                    {"moment_Nm", of.moment.value > 0.0 ? json_of(of.moment) : Json(nullptr)}});
    if (of.components.empty()) continue;
    list.back()["force_by_component_N"] = json_of(part(of, found.space, true));
    list.back()["moment_by_component_Nm"] = json_of(part(of, found.space, false));
  }
  Json residuals = Json::array();
  for (const CalibratedResidual& residual : found.residuals) {
    residuals.push_back({{"estimator", residual.estimator},
                         {"contact_free_s", seconds(residual.stretches, goal)},
                         {"level", json_of(residual.level)},
                         {"change", json_of(residual.change)},
                         {"smoothed", json_of(residual.smoothed)},
                         {"onset", residual.onset ? json_of(*residual.onset) : Json(nullptr)}});
  }
  return json_text(Json{{"false_alarms_per_h", goal.false_alarms_per_hour},
                        {"confidence", goal.confidence},
                        {"safety_factor", goal.safety_factor},
                        {"by_component", goal.by_component},
                        {"one_robot", goal.one_robot},
                        {"warnings", warnings(found)},
                        {"thresholds", list},
                        {"fused_detector", residuals},
                        {"drive_deviations", values_of(found.drive_deviations)}});
}

std::string thresholds_yaml(const ThresholdFindings& found, const std::string& date) {
  ParameterFile file;
  file.kind = "thresholds";
  file.date = date;
  file.robot = found.robot;
  file.recordings = found.recordings;
  file.assumed = found.assumed;
  file.settings = found.settings;
  std::string text =
      parameter_file_text(file) + provenance(found) + "control:\n  contact_detector:\n    by_estimator:\n";
  for (const EstimatorThresholds& of : found.estimators) {
    text += "      - {estimator: " + of.estimator +
            ", reaction_force_N: " + text_of(force_values(of, found.space));
    const std::vector<double> moment = moment_values(of, found.space);
    if (!moment.empty()) text += ", reaction_moment_Nm: " + text_of(moment);
    text += "}\n";
  }
  if (!found.residuals.empty()) text += residuals_yaml(found);
  if (found.drive_deviations.size() > 0) {
    text += fmt::format("  isolation: {{drive_deviation_{}: {}}}\n", found.drives_turn ? "Nm" : "N",
                        text_of(values_of(found.drive_deviations)));
  }
  return text;
}

}  // namespace flinch
