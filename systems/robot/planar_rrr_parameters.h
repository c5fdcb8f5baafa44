#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "systems/robot/planar_leg_parameters.h"

namespace flinch {

/// One leg. The base joint is at base_radius (sin base_angle, -cos base_angle), the coupling joint in
/// platform frame E at coupling_radius (cos coupling_angle, sin coupling_angle).
struct PlanarRrrLeg : PlanarLegParameters {
  double base_radius = 0.0;     ///< r_fix [m]
  double coupling_angle = 0.0;  ///< beta [rad]
};

/// Everything about a planar 3-RRR that moves in a horizontal plane: three legs with revolute joints, the
/// first of each driven. Coupling joints have no friction; the platform's centre of mass is the origin of E.
struct PlanarRrrParameters {
  std::string name = "planar 3-RRR";
  std::array<PlanarRrrLeg, 3> legs;

  double coupling_radius = 0.0;       ///< r_c [m]
  double platform_mass = 0.0;         ///< p4 [kg]
  double platform_inertia = 0.0;      ///< p5, about the origin of E [kg m^2].
  double platform_hull_radius = 0.0;  ///< Outline about the origin of E, body thickness included [m].
  double link_radius = 0.0;           ///< Half the thickness of a link [m].

  /// Coulomb friction is coulomb * tanh(rate / friction_velocity) [rad/s].
  double friction_velocity = 0.01;
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< In the base frame; its x and y must be zero [m/s^2].
  Eigen::Vector3d home_pose{0.0, 0.0, 0.0};  ///< (x, y, phi) that all legs must reach [m, m, rad].
};

/// All that is wrong with `parameters`, one sentence each that begins with the field, such as
/// "legs[1].link1_length is 0 m; it must be positive". Empty when they describe a robot.
std::vector<std::string> problems(const PlanarRrrParameters& parameters);

}  // namespace flinch
