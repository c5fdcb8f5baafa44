#include "calibration/threshold_calibration.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "calibration/gumbel.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::size_t fewest_stretches = 14;
constexpr double furthest_extrapolation = 1000.0;
constexpr double least_threshold = 1e-9;  // [N or Nm]

void append(const std::vector<double>& more, std::vector<double>& all) {
  all.insert(all.end(), more.begin(), more.end());
}

void append(const EstimatorPeaks& more, EstimatorPeaks& all) {
  append(more.force, all.force);
  append(more.moment, all.moment);
  for (std::size_t i = 0; i < all.components.size(); ++i) append(more.components[i], all.components[i]);
}

}  // namespace

CalibratedThreshold calibrated_threshold(const std::vector<double>& peaks, double probability,
                                         const ThresholdGoal& goal, double power) {
  CalibratedThreshold result;
  if (peaks.empty()) return result;
  std::vector<double> raised = peaks;
  for (double& peak : raised) peak = std::pow(peak, power);
  const Gumbel fit = fit_gumbel(raised);
  const auto root = [&](double value) { return std::pow(value, 1.0 / power); };
  result.best_guess = root(fit.quantile_above(probability));
  result.value = root(upper_quantile_above(fit, peaks.size(), probability, goal.confidence));
  result.largest = *std::max_element(peaks.begin(), peaks.end());
  result.papers_rule = goal.safety_factor * result.largest;
  return result;
}

void require_enough(const std::string& estimator, std::size_t stretches, const ThresholdGoal& goal) {
  const double recorded = static_cast<double>(stretches) * to_seconds(goal.stretch);  // [s]
  const double needed = std::max(static_cast<double>(fewest_stretches) * to_seconds(goal.stretch),
                                 3600.0 / goal.false_alarms_per_hour / furthest_extrapolation);
  if (recorded >= needed) return;
  throw SetupError(
      fmt::format("{}: {:.1f} s of motion with valid estimates are recorded; {:.1f} s are needed for {} "
                  "false alarms an hour",
                  estimator, recorded, needed, goal.false_alarms_per_hour));
}

void require_errors(const std::string& of, const CalibratedThreshold& found, double least) {
  if (std::isfinite(found.value) && found.value >= least) return;
  throw SetupError(fmt::format(
      "{}: its errors are at most {:.3g}, which gives a threshold of {:.3g}; these recordings hold "
      "no errors, as where readings are constant; record the robot while it moves, with the noise "
      "that its sensors have",
      of, found.largest, found.value));
}

std::vector<EstimatorThresholds> calibrate_thresholds(const std::vector<EstimatorPeaks>& peaks,
                                                      const ThresholdGoal& goal) {
  std::vector<EstimatorThresholds> all;
  for (const EstimatorPeaks& of : peaks) {
    require_enough(of.estimator, of.force.size(), goal);
    const double alarms_a_stretch = goal.false_alarms_per_hour / 3600.0 * to_seconds(goal.stretch);
    const double share = of.moment.empty() ? 1.0 : 0.5;  // force and moment have half of the alarms each
    all.push_back({.estimator = of.estimator,
                   .stretches = of.force.size(),
                   .force = calibrated_threshold(of.force, share * alarms_a_stretch, goal),
                   .moment = calibrated_threshold(of.moment, share * alarms_a_stretch, goal)});
    require_errors(of.estimator + ", force in N", all.back().force, least_threshold);
    if (!of.moment.empty())
      require_errors(of.estimator + ", moment in Nm", all.back().moment, least_threshold);
    if (!goal.by_component) continue;
    const double part = 1.0 / static_cast<double>(of.components.size());  // of the alarms
    for (const std::vector<double>& component : of.components)
      all.back().components.push_back(calibrated_threshold(component, part * alarms_a_stretch, goal));
    for (const CalibratedThreshold& each : all.back().components)
      require_errors(of.estimator + ", a component in N or Nm", each, least_threshold);
  }
  return all;
}

std::vector<EstimatorThresholds> calibrate_thresholds(const std::vector<EstimatorPeaks>& peaks,
                                                      const ThresholdGoal& goal,
                                                      std::vector<std::string>& left_out) {
  std::vector<EstimatorThresholds> all;
  std::vector<std::string> problems;
  for (const EstimatorPeaks& of : peaks) {
    try {
      all.push_back(calibrate_thresholds({of}, goal).front());
    } catch (const SetupError& error) {
      for (const std::string& problem : error.problems()) problems.push_back(problem);
    }
  }
  if (all.empty() && !problems.empty()) throw SetupError(problems);
  for (const std::string& problem : problems) left_out.push_back(problem + "; it has no threshold");
  return all;
}

std::vector<EstimatorPeaks> pooled(const std::vector<std::vector<EstimatorPeaks>>& recordings) {
  std::vector<EstimatorPeaks> all;
  for (const std::vector<EstimatorPeaks>& recording : recordings) {
    if (&recording == &recordings.front()) {
      all = recording;
      continue;
    }
    bool same = recording.size() == all.size();
    for (std::size_t i = 0; same && i < all.size(); ++i) {
      same = recording[i].estimator == all[i].estimator &&
             recording[i].components.size() == all[i].components.size();
      if (same) append(recording[i], all[i]);
    }
    if (!same) throw SetupError("the recordings have other estimators than the first one");
  }
  return all;
}

}  // namespace flinch
