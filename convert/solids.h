#pragma once

#include <Eigen/Core>

#include "systems/robot/body_dynamics.h"

/// Solids of equal density about their centres, cylinders and capsules along z.
namespace flinch {

double sphere_volume(double radius);
/// Without caps.
double cylinder_volume(double radius, double length);

RigidBodyInertia solid_sphere(double mass, double radius);
RigidBodyInertia solid_cylinder(double mass, double radius, double length);
/// A cylinder of that length with half a sphere at each end.
RigidBodyInertia solid_capsule(double mass, double radius, double length);
RigidBodyInertia solid_box(double mass, const Eigen::Vector3d& half_lengths);

/// Axes whose z points along `direction`, of any length but none.
Eigen::Matrix3d axes_with_z_along(const Eigen::Vector3d& direction);

}  // namespace flinch
