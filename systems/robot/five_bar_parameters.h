#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "systems/robot/planar_leg_parameters.h"

namespace flinch {

/// One leg. The coupling joint of every leg is the point of the platform.
struct FiveBarLeg : PlanarLegParameters {
  Eigen::Vector2d base_joint{0.0, 0.0};  ///< In the base frame [m].
};

/// Everything about a planar five-bar (5R) that moves in a horizontal plane: two legs with revolute joints,
/// the first of each driven, joined in one point that carries a point mass. That joint has no friction.
struct FiveBarParameters {
  std::string name = "five-bar";
  std::array<FiveBarLeg, 2> legs;

  double platform_mass = 0.0;    ///< In the point where the legs meet [kg].
  double platform_radius = 0.0;  ///< Outline about that point [m].
  double link_radius = 0.0;      ///< Half the thickness of a link [m].

  /// Coulomb friction is coulomb * tanh(rate / friction_velocity) [rad/s].
  double friction_velocity = 0.01;
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< In the base frame; its x and y must be zero [m/s^2].
  Eigen::Vector2d home_pose{0.0, 0.0};       ///< (x, y) that both legs must reach [m].
};

/// All that is wrong with `parameters`, one sentence each that begins with the field, such as
/// "legs[1].link1_length is 0 m; it must be positive". Empty when they describe a robot.
std::vector<std::string> problems(const FiveBarParameters& parameters);

}  // namespace flinch
