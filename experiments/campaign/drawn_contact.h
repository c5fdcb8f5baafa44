#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "systems/robot/body.h"
#include "systems/robot/kinematics.h"

namespace flinch {

class ParallelRobot;
class RandomGenerator;
struct Scenario;

/// Where a body of `kind` (see CampaignContact) runs into something.
struct DrawnContact {
  std::string body;                                 ///< "platform", "leg2_link1", "leg3_clamping"
  Eigen::Vector3d position_in_base{0.0, 0.0, 0.0};  ///< of the obstacle [m]
  Eigen::Vector3d normal{0.0, 0.0, 0.0};    ///< of the body's surface, towards the obstacle; 0 of a clamping
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};  ///< of the body there [m/s]
};

/// The robot of a scenario half-way through its motion, and when that is [s].
struct MeetingPoint {
  Kinematics now;
  double time = 0.0;
};

/// Draws a place for an obstacle of `shape` so that it touches a body half-way through the motion of
/// `scenario`, on the side to which that body moves there: the platform within about 45 degrees of its
/// velocity, a link anywhere between 10 and 90 % of its length, a clamping where the links of a leg close: it
/// touches both, or one that is drawn, with a gap of up to `largest_gap` [m] to the other.
/// None where that body does not move (at least 0.02 m/s there), the leg opens, or another body is in the
/// way; another draw may do.
/// Throws SetupError where the robot has no such body, or a hull does not hold the obstacle's position.
std::optional<DrawnContact> draw_contact(const Scenario& scenario, const std::string& kind,
                                         const Shape& shape, RandomGenerator& random,
                                         double largest_gap = 0.0);

/// Draws a place for an obstacle of `shape` so that it touches a body from any side, wherever that moves: the
/// platform from a direction that is drawn, a link on either side between 10 and 90 % of its length. None
/// where another body is in the way. `kind` is that of a body, no clamping. Throws SetupError where a hull
/// does not hold the obstacle's position.
std::optional<DrawnContact> draw_touch(const ParallelRobot& robot, const Kinematics& now,
                                       const std::string& kind, const Shape& shape, RandomGenerator& random);

/// Throws SetupError where the scenario has no motion.
MeetingPoint meeting_point_of(const Scenario& scenario);

}  // namespace flinch
