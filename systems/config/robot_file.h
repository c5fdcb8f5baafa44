#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "systems/config/control_period.h"
#include "systems/config/read_value.h"
#include "systems/robot/drive_parameters.h"
#include "systems/robot/workspace_limits.h"

namespace flinch {

class ParallelRobot;

/// What a robot file says. In apps/robots there is one of every kind with every key explained.
struct RobotFile {
  std::shared_ptr<const ParallelRobot> robot;
  DriveParameters drives;
  WorkspaceLimits limits;
  /// From tick to tick of its control, unless a scenario says otherwise.
  std::chrono::nanoseconds control_period = default_control_period;
  std::vector<ReadValue> values;  ///< Every parameter, defaults included.
};

/// The robot as the file itself says, without what `calibrations` names, which robot_calibrations() reads.
/// Each throws SetupError with all that is wrong with the file, also physically: masses that are not
/// positive, inertia that is not positive definite, a home pose out of reach or outside the workspace limits.
RobotFile read_robot_file(const std::filesystem::path& file);
/// The same for text that came from `file`.
RobotFile parse_robot_file(std::string_view text, const std::string& file);
/// A sound robot of the kind that a file names which is no good otherwise; nothing where it names none.
std::optional<RobotFile> preset_of_kind(const std::filesystem::path& file);
std::shared_ptr<const ParallelRobot> load_robot(const std::filesystem::path& file);

/// Path of the key that says what one ampere does at a drive: "drives.torque_constant_Nm_per_A[0]".
std::string drive_constant_key(const ParallelRobot& robot, int drive);

}  // namespace flinch
