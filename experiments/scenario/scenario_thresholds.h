#pragma once

#include <string>
#include <vector>

namespace flinch {

class ConfigReader;
class ConfigurationSpace;
enum class DriveKind;
struct ContactControlSettings;

/// Reads from which values on a contact is detected, from the sections `contact_detector` and
/// `fused_detector` of `control`. What it says of an estimator, and its list of residuals, take the place
/// of what `settings` hold of them; where it says only the force or only the moment of an estimator, the
/// other stays. `estimators`: all that a file may name, whether they run or not. `space`: the robot's;
/// null: not known.
void read_thresholds(ConfigReader control, DriveKind drives, const ConfigurationSpace* space,
                     const std::vector<std::string>& estimators, ContactControlSettings& settings);

}  // namespace flinch
