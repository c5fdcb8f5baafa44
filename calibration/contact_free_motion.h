#pragma once

#include <string>
#include <utility>
#include <vector>

#include "systems/robot/configuration_space.h"

namespace flinch {

struct Recording;

/// Whether each sample belongs to a nominal motion; where its reference rests for more than 1 s, it does not.
/// Throws SetupError where something touched the robot, or where the robot detected something, so that nobody
/// knows.
std::vector<bool> nominal_samples(const Recording& recording, const ConfigurationSpace& space);

/// Samples of a log's estimates in which the platform has moved within the last second, at a fiftieth of its
/// largest velocity at least: an estimate at rest says little of one in motion.
std::vector<bool> moving_samples(const Recording& estimates);

/// Names of the estimators and the signals of what they say. Throws SetupError where there are none.
std::vector<std::pair<std::string, std::string>> estimates_of(const Recording& recording);

}  // namespace flinch
