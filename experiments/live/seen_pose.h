#pragma once

#include <optional>
#include <string>

#include "systems/robot/parallel_robot.h"
#include "systems/signals/joint_reading.h"

namespace flinch {

/// Where a robot stands by its encoders: what shows whether their signs, zeros and units are right.
struct SeenPose {
  std::optional<ConfigurationSpace> space;  ///< of the robot
  DriveKind drives{};                       ///< likewise
  JointReading joints;
  std::optional<Configuration> platform;  ///< none: the drive positions fit no pose
  std::optional<double> closure_error;    ///< by which passive angles and platform disagree [m]

  /// Two lines; of a robot that told nothing, one.
  std::string text() const;
};

/// The passive angles are the start of the search, else the home pose is.
SeenPose see_pose(const ParallelRobot& robot, const JointReading& joints);

}  // namespace flinch
