#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace flinch {

class ConfigReader;
class ParallelRobot;
struct WorkspaceLimits;

/// A kind of mechanism that robot files can describe. Its drives move alike, and a file says of them, of
/// limits and of calibrations the same as of every robot.
struct RobotKind {
  std::string name;  ///< what a file says at `kind`
  /// The robot that the keys of this kind describe. Notes all that is wrong with them, also physically; null
  /// where something is wrong with the file.
  std::function<std::shared_ptr<const ParallelRobot>(ConfigReader& file)> read;
  /// A sound robot of this kind. It tells how many drives there are and how they move, and stands in for a
  /// robot whose file is no good while the rest of a scenario is looked through. Null where robots of the
  /// kind differ in drives and coordinates, so that only a file that is good tells.
  std::shared_ptr<const ParallelRobot> preset;
  /// Sets what follows from a robot of this kind about where it may be, for what its file leaves out; none:
  /// nothing.
  std::function<void(const ParallelRobot& robot, WorkspaceLimits& limits)> begin_limits = {};
};

/// Lets robot files be of one more kind, anywhere in this program, which brings its own mechanism. Call it
/// from one thread, before anything is read. Throws SetupError where the kind is incomplete, its drives do
/// not move alike, or there is one of that name.
void add_robot_kind(RobotKind kind);

/// All kinds: those of the library, then those that were added.
const std::vector<RobotKind>& robot_kinds();

}  // namespace flinch
