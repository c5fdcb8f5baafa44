#include "calibration/thresholds_output.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "calibration/threshold_calibration.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const CalibratedThreshold& threshold) {
  return {{"value", threshold.value},
          {"best_guess", threshold.best_guess},
          {"largest", threshold.largest},
          {"papers_rule", threshold.papers_rule}};
}

std::string row(const std::string& estimator, const char* quantity, const CalibratedThreshold& threshold,
                const char* unit) {
  return fmt::format("{:<28} {:<6} {:>9.3g} {:>9.3g} {:>9.3g} {:>9.3g}  {}\n", estimator, quantity,
                     threshold.value, threshold.best_guess, threshold.largest, threshold.papers_rule, unit);
}

double seconds(const EstimatorThresholds& thresholds, const ThresholdGoal& goal) {
  return static_cast<double>(thresholds.stretches) * to_seconds(goal.stretch);
}

}  // namespace

std::string thresholds_table(const std::vector<EstimatorThresholds>& thresholds, const ThresholdGoal& goal) {
  std::string text =
      fmt::format("for {} false alarms an hour of each estimator, kept with a confidence of {:.0f} %\n\n",
                  goal.false_alarms_per_hour, 100.0 * goal.confidence);
  text += fmt::format("{:<28} {:<6} {:>9} {:>9} {:>9} {:>9}\n", "estimator", "of", "threshold", "guess",
                      "largest", fmt::format("{:.3g} x max", goal.safety_factor));
  for (const EstimatorThresholds& of : thresholds) {
    text += row(of.estimator, "force", of.force, "N");
    if (of.moment.value > 0.0) text += row("", "moment", of.moment, "Nm");
  }
  if (!thresholds.empty()) {
    text += fmt::format("\nfrom {:.1f} s of motion without contact, in stretches of {} s\n",
                        seconds(thresholds.front(), goal), to_seconds(goal.stretch));
  }
  return text;
}

std::string thresholds_json(const std::vector<EstimatorThresholds>& thresholds, const ThresholdGoal& goal) {
  Json list = Json::array();
  for (const EstimatorThresholds& of : thresholds) {
    list.push_back({{"estimator", of.estimator},
                    {"contact_free_s", seconds(of, goal)},
                    {"force_N", json_of(of.force)},
                    {"moment_Nm", of.moment.value > 0.0 ? json_of(of.moment) : Json(nullptr)}});
  }
  return Json{{"false_alarms_per_h", goal.false_alarms_per_hour},
              {"confidence", goal.confidence},
              {"safety_factor", goal.safety_factor},
              {"thresholds", list}}
      .dump();
}

std::string thresholds_yaml(const std::vector<EstimatorThresholds>& thresholds, const ThresholdGoal& goal,
                            const std::vector<std::string>& recordings) {
  std::string text = fmt::format(
      "# Thresholds for {} false alarms an hour of each estimator, kept with a confidence of {:.0f} %. "
      "From:\n",
      goal.false_alarms_per_hour, 100.0 * goal.confidence);
  for (const std::string& recording : recordings) text += "#   " + recording + "\n";
  text += "# Belongs into the section 'control' of a scenario.\ncontact_detector:\n  by_estimator:\n";
  for (const EstimatorThresholds& of : thresholds) {
    text += fmt::format("    - {{estimator: {}, reaction_force_N: {:.4g}", of.estimator, of.force.value);
    if (of.moment.value > 0.0) text += fmt::format(", reaction_moment_Nm: {:.4g}", of.moment.value);
    text += "}\n";
  }
  return text;
}

}  // namespace flinch
