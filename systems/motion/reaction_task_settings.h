#pragma once

#include <optional>
#include <string>
#include <vector>

#include "systems/framework/time.h"
#include "systems/motion/jerk_limited_profile.h"
#include "systems/signals/task_list.h"

namespace flinch {

struct ReactionTaskSettings {
  double displacement = 0.10;       ///< d_react, of the platform or the touched point [m]
  double first_link_angle = 0.25;   ///< [rad]
  double opening_angle = 0.2094;    ///< of the first link; the second opens against it by twice as much [rad]
  double opening_step = 0.1047;     ///< by which it is opened further while it still clamps [rad]
  double largest_opening = 0.6981;  ///< of the first link, in all [rad]
  bool opening_by_priority = false;  ///< of the first link over the elbow, (31a), (31b); false: both alike
  bool along_force_only = false;     ///< platform and second link: only the direction of the force is a task
  double force_to_go_by = 3.0;       ///< a weaker force has no reliable direction [N],
  double load_to_go_by = 1.5;        ///< nor a weaker load of a first link's drive [Nm or N]
  bool retreat = true;               ///< the way it came, from what is not known; false: brake
  Time decide_within = 20ms;         ///< of the detection: so long what is not known may still become known
  double released_force = 5.0;       ///< a leg is released where no force component reaches it [N],
  double released_moment = 0.5;      ///< no moment component this [Nm],
  Time released_for = 100ms;         ///< for so long
  Time pressed_for = 20ms;           ///< where such a force stays so long, it is given way to anew
  /// Of the force that accelerates the robot, which it may feel without a contact.
  double inertial_share = 0.05;
  MotionLimits translation{.velocity = 1.0, .acceleration = 60.0, .jerk = 8000.0};
  MotionLimits joint{.velocity = 4.0, .acceleration = 80.0, .jerk = 8000.0};
  /// Of its coupling joints, to which motions of joints are slowed down [m/s].
  double largest_platform_speed = 2.0;
  /// Motions are planned with this share of what all drives together can do about them, in the place of the
  /// accelerations and jerks above; none: with those.
  std::optional<double> drive_share;
  /// After a motion the robot has come to rest when all drives are slower than this [rad/s or m/s].
  double rest_speed = 0.05;
  Time longest_braking = 150ms;   ///< If it has not by then, its place is held all the same.
  double max_torque = 100.0;      ///< of a drive [Nm or N]
  double max_torque_rate = 20e3;  ///< [Nm/s or N/s]

  /// [SafePR] Table III, the same for every row.
  TaskGains platform = TaskGains::uniform(1, 30.0, 2000.0, 50.0, 2000.0, 1.0);
  TaskGains first_link = TaskGains::uniform(1, 10.0, 1250.0, 50.0, 2500.0, 1.0);
  TaskGains second_link = TaskGains::uniform(1, 10.0, 1250.0, 50.0, 2000.0, 1.0);
  TaskGains opening = TaskGains::uniform(1, 10.0, 1250.0, 75.0, 1000.0, 1.0);
};

/// All that is wrong with `settings`.
std::vector<std::string> problems(const ReactionTaskSettings& settings);

}  // namespace flinch
