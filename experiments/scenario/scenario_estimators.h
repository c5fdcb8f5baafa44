#pragma once

namespace flinch {

class ConfigReader;
class ParallelRobot;
struct ContactControlSettings;

/// Reads from the section `control` of a scenario what each wrench estimator is set to, whether it runs or
/// not.
void read_estimators(ConfigReader& control, const ParallelRobot& robot, ContactControlSettings& settings);

}  // namespace flinch
