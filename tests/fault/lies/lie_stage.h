#pragma once

#include <string>

#include "systems/config/robot_file.h"

namespace flinch::test {

/// A robot of apps/robots as lies are told to it: how it moves, what it runs into, how large lies are.
struct LieStage {
  std::string file;  ///< of the robot
  RobotFile robot;
  double acceleration;  ///< of its motions [m/s^2]
  double jerk;          ///< [m/s^3]
  double cruise;        ///< before and after the middle [m]
  double contact_deg;   ///< direction of the motion that ends at an obstacle
  /// The section of a scenario with that obstacle, touched so much before the middle [mm].
  std::string (*obstacle)(double earlier_mm);
  std::string control;   ///< that section of a scenario, for a robot that differs from its model
  double angle = 1.0;    ///< times sizes of lies that are angles of a drive of the rig
  double current = 1.0;  ///< currents
  double torque = 1.0;   ///< torques
};

/// That of "planar_3rrr", the rig, "five_bar" or "hexapod_6ups".
const LieStage& lie_stage(const std::string& robot);

}  // namespace flinch::test
