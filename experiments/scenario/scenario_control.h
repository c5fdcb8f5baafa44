#pragma once

#include <cstdint>

namespace flinch {

class ConfigReader;
class ParallelRobot;
struct RobotFile;
struct ContactControlSettings;

/// Reads the section `control` of a scenario. Of the stages in `settings`, all that can be named, those are
/// left which it chooses.
void read_control(ConfigReader control, const ParallelRobot& robot, ContactControlSettings& settings);

/// Reads the section `motion` of a scenario into the nominal motion; a random one follows from `seed`. A
/// motion that the robot cannot make is a problem of the section.
void read_motion(ConfigReader motion, const RobotFile& robot, std::uint64_t seed,
                 ContactControlSettings& settings);

}  // namespace flinch
