#pragma once

#include "systems/robot/configuration_space.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// The line along which a force acts that alone makes a platform wrench, for people and things that touch a
/// robot hand on no moment of their own. Points on it: x_t + lever + s direction. [SafePR] (14)-(16)
struct LineOfAction {
  bool valid = false;      ///< There is a force to speak of; otherwise lever and direction are zero.
  bool has_lever = false;  ///< The platform can be turned; otherwise its wrench does not tell where it lies.
  CartesianVector lever;   ///< r_min: from the platform's origin to the line, square to it, base frame [m]
  CartesianVector direction;  ///< n: of the force on the robot, a unit vector
  /// |m . n| / |m|: how much of the moment no single force can make. 0 in the plane; in space far from 0
  /// where several things touch the robot.
  double moment_along_force = 0.0;
};

/// The line of action of `wrench` (moment about the platform's origin), where its force is at least
/// `least_force` [N]. Not valid for a wrench that is not one of this space.
LineOfAction line_of_action(const ConfigurationSpace& space, const PlatformVector& wrench,
                            double least_force) noexcept;

/// How far `point` lies from the line, the platform's origin being at `origin` [m]. [SafePR] (17)
double distance_to_line(const LineOfAction& line, const CartesianVector& origin,
                        const CartesianVector& point) noexcept;

/// Angle between two vectors of 2 or 3 entries, 0 to pi [rad]. [SafePR] (18); 0 where one of them is zero.
double angle_between(const CartesianVector& a, const CartesianVector& b) noexcept;

}  // namespace flinch
