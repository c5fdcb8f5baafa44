#pragma once

#include <string_view>

#include "systems/robot/vectors.h"

namespace flinch {

class ConfigReader;
class ConfigurationSpace;
class Mechanism;
class ParallelRobot;

/// Reads a pose of the mechanism. Keys that are not there keep the home pose's position and the upright
/// orientation:
///   x, y, z    position of the platform [m]; z in space only
///   phi        rotation of a planar platform [rad]
///   rotation   rotation vector of a spatial platform, against the base frame [rad]
Configuration read_pose(ConfigReader pose, const Mechanism& mechanism);

/// Reads the pose `name` of a section in the same way; one that the legs do not reach is a problem.
Configuration read_pose_in_reach(ConfigReader& section, std::string_view name, const ParallelRobot& robot);

/// Reads a displacement in the base frame, by the same keys; those that are not there are zero.
PlatformVector read_step(ConfigReader step, const ConfigurationSpace& space);

}  // namespace flinch
