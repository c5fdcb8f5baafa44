#pragma once

#include <string>
#include <vector>

#include "systems/framework/time.h"
#include "systems/robot/configuration_space.h"

namespace flinch {

struct Recording;

/// What an estimator said in motion without contact: the largest component of force and of moment in each
/// stretch of time.
struct EstimatorPeaks {
  std::string estimator;
  std::vector<double> force;   ///< [N]
  std::vector<double> moment;  ///< [Nm]; empty for a robot that does not turn
  /// The same of each component by itself: forces along the axes of the base frame, then moments about them.
  std::vector<std::vector<double>> components;
};

/// The peaks of every estimator of a recording, in stretches of length `stretch` in which its estimate was
/// valid and a nominal motion followed throughout that did not rest for more than 1 s. `space` is that of the
/// recorded robot. Throws SetupError, without naming the file, where the recording has no estimates, where
/// something touched the robot, where the robot detected something, so that nobody knows, or where nobody
/// watched and one peak cannot be of the same motion as the others.
std::vector<EstimatorPeaks> contact_free_peaks(const Recording& recording, const ConfigurationSpace& space,
                                               Time stretch);

/// The same of the estimates of a log, estimates_of_log(), in samples that `counts` names: moving_samples()
/// that somebody says are free of contact.
std::vector<EstimatorPeaks> contact_free_peaks(const Recording& estimates, const std::vector<bool>& counts,
                                               const ConfigurationSpace& space, Time stretch);

}  // namespace flinch
