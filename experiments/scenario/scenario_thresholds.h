#pragma once

#include <string>
#include <vector>

namespace flinch {

class ConfigReader;
class ParallelRobot;
struct ContactControlSettings;

/// Reads from which values on a contact is noticed, from the sections `contact_detector` and `fused_detector`
/// of `control`. What it says of an estimator, and its list of residuals, take the place of what `settings`
/// hold of them. `estimators`: all that a file may name, whether they run or not.
void read_thresholds(ConfigReader control, const ParallelRobot& robot,
                     const std::vector<std::string>& estimators, ContactControlSettings& settings);

}  // namespace flinch
