#pragma once

#include <optional>
#include <vector>

#include "experiments/campaign/drawn_contact.h"
#include "plant/obstacle_path.h"

namespace flinch {

struct CampaignContact;

/// How an obstacle moves that touches a body: from `position_in_base` along `path`.
struct DrawnMove {
  Eigen::Vector3d position_in_base{0.0, 0.0, 0.0};  ///< [m]
  std::vector<PathPoint> path;
};

/// Of the spring that leads an obstacle which pushes [N/m].
inline constexpr double pushing_stiffness = 500.0;

/// Draws a motion of the obstacle so that it is at the place of `contact` at `time` [s], with a velocity in a
/// direction that is drawn. `directions`: in which the robot's points move. None where body and obstacle do
/// not approach one another (at least 0.05 m/s).
std::optional<DrawnMove> draw_meeting(const CampaignContact& settings, const DrawnContact& contact,
                                      double time, int directions, RandomGenerator& random);

/// Draws a push: from 5 mm off the body, from `begin` [s] on against it and back, so far that the spring
/// which leads the obstacle presses with the force drawn on a body that does not give way.
DrawnMove draw_push(const CampaignContact& settings, const DrawnContact& contact, double begin,
                    int directions, RandomGenerator& random);

}  // namespace flinch
