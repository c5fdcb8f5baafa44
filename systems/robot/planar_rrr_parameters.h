#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace flinch {

/// Friction torque viscous * rate + coulomb * sign(rate).
struct JointFriction {
  double viscous = 0.0;  ///< [Nm s/rad]
  double coulomb = 0.0;  ///< [Nm]
};

/// Inertia of one link as a rigid body.
struct LinkBody {
  double mass = 0.0;            ///< [kg]
  double centre_of_mass = 0.0;  ///< On the link axis, from the proximal joint [m].
  double inertia = 0.0;         ///< About the centre of mass [kg m^2].
};

/// Base parameters: all of a leg's inertia that motion depends on [kg m^2].
/// M_leg = [p1 + 2 p3 c, p2 + p3 c; p2 + p3 c, p2] in (q_a, q_p), c = cos q_p. [ICRA23] II-B
struct LegInertia {
  double p1 = 0.0;  ///< I1 + m1 s1^2 + m2 l1^2 + m2 s2^2 + I2, without the rotor.
  double p2 = 0.0;  ///< I2 + m2 s2^2
  double p3 = 0.0;  ///< m2 l1 s2
};

/// Base parameters of a leg that consists of these two links.
LegInertia base_parameters(const LinkBody& link1, const LinkBody& link2, double link1_length);

/// One leg. The base joint is at base_radius (sin base_angle, -cos base_angle), the coupling joint in
/// platform frame E at coupling_radius (cos coupling_angle, sin coupling_angle).
struct PlanarRrrLeg {
  double base_angle = 0.0;      ///< psi: direction from which the drive angle is measured [rad].
  double base_radius = 0.0;     ///< r_fix [m]
  double coupling_angle = 0.0;  ///< beta [rad]
  double link1_length = 0.0;    ///< l1 [m]
  double link2_length = 0.0;    ///< l2 [m]
  int elbow_sign = 1;           ///< Working mode at home: sign of the passive angle.

  LegInertia inertia;
  double rotor_inertia = 0.0;  ///< Of the drive, about the base joint [kg m^2].
  JointFriction active_friction;
  JointFriction passive_friction;
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
