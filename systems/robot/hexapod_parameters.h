#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "systems/robot/body_dynamics.h"
#include "systems/robot/joint_friction.h"

namespace flinch {

/// One leg: a universal joint on the base, a cylinder and a rod that slides in it, and a spherical joint on
/// the platform.
struct HexapodLeg {
  Eigen::Vector3d base_joint{0.0, 0.0, 0.0};      ///< a, in the base frame [m].
  Eigen::Vector3d platform_joint{0.0, 0.0, 0.0};  ///< b, in frame E [m].
  Eigen::Vector3d universal_axis{0.0, 0.0, 0.0};  ///< k: unit vector along the first axis, fixed to the base.
  double mass_scale = 1.0;                        ///< Times masses and moments of inertia of the links below.
  JointFriction drive_friction;                   ///< Along the leg [N s/m], [N].
  JointFriction universal_friction;               ///< About each of the two axes [Nm s/rad], [Nm].
};

/// Everything about a hexapod 6-UPS, or Gough-Stewart platform: six legs, each driven in its length, with
/// links of one make.
/// Body frames: the platform's is E; the cylinder's has its origin on the base joint, the rod's on the
/// platform joint, and the z axis of both points along the leg to the platform.
struct HexapodParameters {
  std::string name = "hexapod";
  std::array<HexapodLeg, 6> legs;

  /// The rod slides in the cylinder: the distance of a leg's joints is more than `rod_length` and less than
  /// `rod_length` + `cylinder_length` [m].
  double cylinder_length = 0.0;
  double rod_length = 0.0;
  double cylinder_radius = 0.0;  ///< Outline [m].
  double rod_radius = 0.0;       ///< Outline [m].
  RigidBodyInertia cylinder;
  RigidBodyInertia rod;
  double drive_armature = 0.0;  ///< Rotor and screw of a drive, felt along the leg [kg].
  /// Coulomb friction is coulomb * tanh(rate / velocity).
  double drive_friction_velocity = 0.01;      ///< [m/s]
  double universal_friction_velocity = 0.01;  ///< [rad/s]

  RigidBodyInertia platform;
  std::optional<RigidBodyInertia> payload;  ///< Fixed to the platform, in frame E.
  /// Outline of the platform: a prism of twelve sides about the z axis of E, between two heights [m].
  double platform_radius = 0.0;
  double platform_bottom = 0.0;
  double platform_top = 0.0;

  Eigen::Vector3d gravity{0.0, 0.0, -9.81};      ///< In the base frame [m/s^2].
  Eigen::Vector3d home_position{0.0, 0.0, 0.0};  ///< Of E, in reach of all legs [m].
  Eigen::Vector3d home_rotation{0.0, 0.0, 0.0};  ///< Of E, as a rotation vector [rad].
  double characteristic_length = 0.0;  ///< Makes angles comparable to distances, as in `Kinematics` [m].
};

/// All that is wrong with `parameters`, one sentence each that begins with the field, such as
/// "rod_length is 0 m; it must be positive". Empty when they describe a robot.
std::vector<std::string> problems(const HexapodParameters& parameters);

}  // namespace flinch
