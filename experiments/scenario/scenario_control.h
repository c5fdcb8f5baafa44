#pragma once

namespace flinch {

class ConfigReader;
class ParallelRobot;
struct ContactControlSettings;

/// Reads the section `control` of a scenario. Of the stages in `settings`, all that can be named, those are
/// left which it chooses.
void read_control(ConfigReader control, const ParallelRobot& robot, ContactControlSettings& settings);

/// Reads the section `motion` of a scenario into the nominal motion. Throws SetupError for a motion that the
/// robot cannot make, with the line of the section.
void read_motion(ConfigReader motion, const ParallelRobot& robot, ContactControlSettings& settings);

}  // namespace flinch
