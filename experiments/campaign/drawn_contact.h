#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "systems/robot/body.h"

namespace flinch {

class RandomGenerator;
struct Scenario;

/// Where a body of `kind` (see CampaignContact) runs into something.
struct DrawnContact {
  std::string body;                                 ///< "platform", "leg2_link1", "leg3_clamping"
  Eigen::Vector3d position_in_base{0.0, 0.0, 0.0};  ///< of the obstacle [m]
};

/// Draws a place for an obstacle of `shape` so that it touches a body half-way through the motion of
/// `scenario`, on the side to which that body moves there: the platform within about 45 degrees of its
/// velocity, a link anywhere between 10 and 90 % of its length, a clamping where the links of a leg close.
/// None where that body does not move (at least 0.02 m/s there), the leg opens, or another body is in the
/// way; another draw may do.
/// Throws SetupError where the robot has no such body.
std::optional<DrawnContact> draw_contact(const Scenario& scenario, const std::string& kind,
                                         const Shape& shape, RandomGenerator& random);

}  // namespace flinch
