#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "systems/robot/body_dynamics.h"
#include "systems/robot/dynamic_parameters.h"

namespace flinch {

/// What motion depends on linearly of a rigid body: mass [kg], mass times centre of mass [kg m], and inertia
/// about the origin of its frame (xx, yy, zz, xy, xz, yz) [kg m^2].
using BodyMoments = Eigen::Matrix<double, 10, 1>;

BodyMoments moments_of(const RigidBodyInertia& body);
/// The body that has them; they need not be physical, and its mass is not 0.
RigidBodyInertia body_of(const BodyMoments& moments);

/// "mass", "first_moment_x", "I_xx", and their units.
const char* moment_name(int index);
const char* moment_unit(int index);

/// The pseudo-inertia, positive definite for a body whose density is nowhere negative: so each moment of
/// inertia is less than the sum of the other two. [Wensing, Kim and Slotine, IEEE RA-L 3(1), 2018, (8)]
Eigen::Matrix4d pseudo_inertia(const BodyMoments& moments);
/// The same of what motion in the plane z = 0 feels of it: mass, centre of mass and I_zz.
Eigen::Matrix3d planar_pseudo_inertia(const BodyMoments& moments);

/// What a robot file says of the body below the key `path`: mass_kg, centre_of_mass_m, inertia_kg_m2,
/// inertia_products_kg_m2.
std::vector<FileValue> body_in_file(const std::string& path, const RigidBodyInertia& body);

}  // namespace flinch
