#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "systems/framework/time.h"
#include "systems/robot/configuration_space.h"

namespace flinch {

struct Recording;

/// Where a stretch of time lies.
struct Stretch {
  std::size_t recording = 0;  ///< of several, from 0
  double begin = 0.0;         ///< [s]
};

/// What an estimator said in motion without contact: the largest component of force and of moment in each
/// stretch of time.
struct EstimatorPeaks {
  std::string estimator;
  std::vector<double> force;         ///< [N]
  std::vector<double> moment;        ///< [Nm]; empty for a robot that does not turn
  std::vector<Stretch> stretches{};  ///< of each; empty where nobody knows
};

/// The peaks of every estimator of a recording, in stretches of length `stretch` in which its estimate was
/// valid and a nominal motion followed throughout that did not rest for more than 1 s. `space` is that of the
/// recorded robot. Throws SetupError, without naming the file, where the recording has no estimates, where
/// something touched the robot, or where the robot noticed something, so that nobody knows.
std::vector<EstimatorPeaks> contact_free_peaks(const Recording& recording, const ConfigurationSpace& space,
                                               Time stretch);

}  // namespace flinch
