#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/simulated/simulated_scenario.h"

namespace flinch::test {

/// Contact-free motion of the planar rig at 1.5 m/s, 12 m/s^2 and 600 m/s^3.
enum class FreeMotion {
  square,          ///< of 300 mm, two laps: square_realistic.yaml
  point_to_point,  ///< between random poses in the workspace, for about six seconds
  harsh,           ///< the same at 17 m/s^2 and 2000 m/s^3
};

/// What a robot is tried with.
struct RobotTrial {
  FreeMotion motion = FreeMotion::square;
  bool realistic = true;  ///< Otherwise the robot is its model; noise and motion are the same.
  bool aligned = true;    ///< Torques are filtered as the velocity is.
};

/// The trial with the robot, the noise and the poses that `seed` draws. `reacts`: as shipped, at 10 N or 1
/// Nm; otherwise the robot goes on whatever the observer estimates.
SimulatedScenario scenario_of(const RobotTrial& trial, std::uint64_t seed, bool reacts);

/// What one or more robots showed.
struct FreeMotionErrors {
  int robots = 0;
  double seconds = 0.0;
  double largest_force = 0.0, p99_force = 0.0;    ///< Of any component of the estimate, at any tick [N].
  double largest_moment = 0.0, p99_moment = 0.0;  ///< [Nm]
  double tracking = 0.0;                          ///< Largest distance from the reference [m].
  int crossings = 0;                ///< How often 10 N or 1 Nm was reached, where the robot goes on.
  int alarmed_robots = 0;           ///< Robots that stopped for a contact that was none, as shipped.
  std::vector<std::string> faults;  ///< Why torque gates closed, with the seed, as shipped or going on.
};

/// Tries `robots` robots, from `first_seed` on, on all processors; the result depends on neither their number
/// nor their order.
FreeMotionErrors try_robots(const RobotTrial& trial, int robots, std::uint64_t first_seed = 1);

/// A row of a table, and its head.
std::string table_head();
std::string table_row(const RobotTrial& trial, const FreeMotionErrors& errors);

}  // namespace flinch::test
