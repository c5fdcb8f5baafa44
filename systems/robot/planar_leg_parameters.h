#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "systems/foundation/findings.h"
#include "systems/robot/body.h"
#include "systems/robot/body_id.h"
#include "systems/robot/joint_friction.h"
#include "systems/robot/robot_deviation.h"

namespace flinch {

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

/// What every planar leg of two links has, whatever it is fixed to: revolute joints, the first of which is
/// driven.
struct PlanarLegParameters {
  double base_angle = 0.0;    ///< psi: direction from which the drive angle is measured [rad].
  double link1_length = 0.0;  ///< l1 [m]
  double link2_length = 0.0;  ///< l2 [m]
  int elbow_sign = 1;         ///< Working mode at home: sign of the passive angle.

  LegInertia inertia;
  double rotor_inertia = 0.0;  ///< Of the drive, about the base joint [kg m^2].
  JointFriction active_friction;
  JointFriction passive_friction;
};

/// Adds the outlines of the links of the next leg, capsules along their x axes.
void add_links(const PlanarLegParameters& leg, double link_radius, std::vector<Body>& bodies);

/// The platform, a disc about its origin, and the links of all legs.
template <class Leg, std::size_t count>
std::vector<Body> planar_bodies(double platform_radius, const std::array<Leg, count>& legs,
                                double link_radius) {
  std::vector<Body> bodies = {{body_name(BodyId::platform()), -1, {Sphere{.radius = platform_radius}}}};
  for (const Leg& leg : legs) add_links(leg, link_radius, bodies);
  return bodies;
}

/// Leg `i` of a robot with these differences.
template <class Leg>
Leg deviating_leg(Leg leg, const RobotDeviation& deviation, std::size_t i) {
  const double inertia = scale_of(deviation.leg_inertia_scale, i);
  leg.inertia = {leg.inertia.p1 * inertia, leg.inertia.p2 * inertia, leg.inertia.p3 * inertia};
  leg.active_friction = scaled(leg.active_friction, scale_of(deviation.drive_friction_scale, i));
  leg.passive_friction = scaled(leg.passive_friction, scale_of(deviation.passive_friction_scale, i));
  return leg;
}

/// Adds what is wrong with a leg, `path` before each field.
void find_problems(const std::string& path, const PlanarLegParameters& leg, Findings& findings);

/// Adds what is wrong with `gravity`: a robot that moves in the horizontal plane holds nothing against it.
void find_gravity_problems(const Eigen::Vector3d& gravity, Findings& findings);

/// Adds that a leg cannot span `distance` [m] from base to coupling joint at home, where that is so.
void find_reach_problem(std::size_t index, const PlanarLegParameters& leg, double distance,
                        Findings& findings);

}  // namespace flinch
