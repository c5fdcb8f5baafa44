#pragma once

#include <string>
#include <vector>

#include "calibration/contact_free_peaks.h"
#include "systems/framework/time.h"

namespace flinch {

/// What is asked of thresholds.
struct ThresholdGoal {
  double false_alarms_per_hour = 0.5;  ///< of an estimator, by its force and its moment together
  double confidence = 0.95;    ///< with which the rate is kept, as far as the peaks speak for all motion
  double safety_factor = 2.0;  ///< of the papers' rule, which is told for comparison
  bool by_component = false;   ///< a threshold for each component of force and moment
  bool one_robot = false;      ///< all recordings are of the robot that the thresholds shall serve
  Time stretch = 500ms;        ///< longer than a peak lasts, so that peaks are independent
};

/// The threshold of one quantity, and what it rests on.
struct CalibratedThreshold {
  double value = 0.0;        ///< [N or Nm]
  double best_guess = 0.0;   ///< without the margin for few peaks
  double largest = 0.0;      ///< that was seen
  double papers_rule = 0.0;  ///< safety factor x largest, [RAL25] V-C
};

struct EstimatorThresholds {
  std::string estimator;
  std::size_t stretches = 0;
  CalibratedThreshold force;   ///< of each component
  CalibratedThreshold moment;  ///< likewise; zero for a robot that does not turn
  /// Of each component by itself, forces first; empty where that was not asked.
  std::vector<CalibratedThreshold> components = {};
};

/// Thresholds for a stated rate of false alarms, from the peaks of motion without contact: the largest of a
/// stretch follows a Gumbel distribution, whose upper confidence bound is taken at the rate. Throws
/// SetupError where there are fewer than 14 stretches, where the rate asked is more than 1000 times rarer
/// than what was recorded can show, or where the recordings hold no errors.
std::vector<EstimatorThresholds> calibrate_thresholds(const std::vector<EstimatorPeaks>& peaks,
                                                      const ThresholdGoal& goal);

/// Of those estimators of which there is enough; of others it is added to `left_out` what they lack. Throws
/// SetupError where no estimator is left.
std::vector<EstimatorThresholds> calibrate_thresholds(const std::vector<EstimatorPeaks>& peaks,
                                                      const ThresholdGoal& goal,
                                                      std::vector<std::string>& left_out);

/// Stretches below which the margin for few is a good part of a threshold.
inline constexpr std::size_t few_stretches = 60;

/// What the largest of a stretch exceeds with this probability, from such peaks; all zero without any. It is
/// the `power` of the peaks that follows a Gumbel distribution.
CalibratedThreshold calibrated_threshold(const std::vector<double>& peaks, double probability,
                                         const ThresholdGoal& goal, double power = 1.0);
/// Throws SetupError where so many stretches are too few, as `calibrate_thresholds`.
void require_enough(const std::string& estimator, std::size_t stretches, const ThresholdGoal& goal);

/// Throws SetupError where a threshold of `of` is below `least`: recordings without errors tell nothing.
void require_errors(const std::string& of, const CalibratedThreshold& found, double least);

/// All peaks of the same estimators together. Throws SetupError where one has other estimators.
std::vector<EstimatorPeaks> pooled(const std::vector<std::vector<EstimatorPeaks>>& recordings);

}  // namespace flinch
