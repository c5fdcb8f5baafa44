#pragma once

#include <Eigen/Core>
#include <array>

#include "systems/robot/hexapod_parameters.h"
#include "systems/robot/kinematics.h"

/// Where the legs of a hexapod may run into its platform. A rod ends in a joint within the platform's
/// outline, so it overlaps with it there in every pose; what is said here is of the rest of it.
namespace flinch {

/// Of a point in frame E from the outline of the platform [m]; 0 within it.
double distance_from_platform(const HexapodParameters& robot, const Eigen::Vector3d& point) noexcept;

/// The stretch of each rod that belongs to its joint, from there: twice what overlaps at home [m]. (Derived.)
std::array<double, 6> held_stretches(const HexapodParameters& robot) noexcept;

/// Least gap of the surfaces of the platform and of a cylinder, or of a rod beyond its held stretch [m]; 0
/// where they overlap. Of reachable kinematics.
double leg_platform_gap(const HexapodParameters& robot, const std::array<double, 6>& held,
                        const Kinematics& kinematics) noexcept;

}  // namespace flinch
