#pragma once

namespace flinch {

class ConfigReader;
class ParallelRobot;
struct TaskSettings;

/// Reads the sections `tasks` and `constraints` of `control`: how laws serve tasks by priority, and what they
/// keep before them.
void read_tasks(ConfigReader& control, const ParallelRobot& robot, TaskSettings& settings);

}  // namespace flinch
