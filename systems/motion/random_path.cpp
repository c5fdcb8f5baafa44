#include "systems/motion/random_path.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"

namespace flinch {
namespace {

constexpr double spare = 0.1;
constexpr int most_draws = 1000;            // for one pose
constexpr double step = 2e-3;               // at which a way is looked at [s]
constexpr std::size_t most_poses = 50'000;  // of a path
constexpr int most_ways = 500'000;          // that are planned
constexpr double longest_look = 20'000.0;   // at all of them [s]

/// Uniform in the ball of this radius, of as many dimensions as `part` has.
template <class Part>
void draw_in_ball(double radius, RandomGenerator& random, Part part) {
  if (part.size() == 0) return;
  do {
    for (Eigen::Index i = 0; i < part.size(); ++i) part[i] = random.uniform(-1.0, 1.0);
  } while (part.norm() > 1.0);
  part *= radius;
}

/// `limits`, by `spare` of each inside of them.
WorkspaceLimits spared(WorkspaceLimits limits) {
  const double room = spare * (limits.max_active - limits.min_active) / 2.0;
  limits.min_abs_det_A *= 1.0 + spare;
  limits.min_abs_det_B *= 1.0 + spare;
  limits.min_self_collision_distance *= 1.0 + spare;
  limits.min_platform_gap *= 1.0 + spare;
  limits.max_distance *= 1.0 - spare;
  limits.max_rotation *= 1.0 - spare;
  if (std::isinf(room)) return limits;  // where one end is open, nothing says how much that is
  limits.min_active += room;
  limits.max_active -= room;
  return limits;
}

bool is_inside(const ParallelRobot& robot, const Kinematics& k, const RandomPathSettings& settings) {
  return is_within(spared(settings.workspace), robot, k) &&
         k.rates.active.cwiseAbs().maxCoeff() <= (1.0 - spare) * settings.max_drive_speed;
}

/// From rest to rest [s], whether the legs reach it or not.
double time_of_way(const ParallelRobot& robot, const Configuration& from, const Configuration& to,
                   const PoseLimits& limits) {
  const PlatformVector rest = PlatformVector::Zero(robot.dof());
  return PoseMotion::plan(robot.space(), from, rest, robot.difference(to, from), limits).duration();
}

/// What is drawn and planned for a path. It is bounded, whatever the settings are.
struct Effort {
  std::size_t poses = 0;
  int ways = 0;
  double looked_at = 0.0;  ///< [s]

  /// Throws SetupError where it has become too much for `duration` of the path.
  void check(const RandomPathSettings& settings, double duration) const {
    std::ostringstream text;
    if (poses >= most_poses) {
      text << poses << " random poses within " << settings.distance << " m and " << settings.rotation
           << " rad of the centre last " << duration << " s of " << settings.duration
           << " s, and there may be no more; raise distance, rotation or pause, or lower duration";
    } else if (ways >= most_ways || looked_at >= longest_look) {
      text << "of " << ways << " random ways, " << looked_at
           << " s long, those within the robot's limits last " << duration << " s of " << settings.duration
           << " s; lower distance, rotation or duration";
    } else {
      return;
    }
    throw SetupError(text.str());
  }
};

Configuration centre_of(const ParallelRobot& robot, const RandomPathSettings& settings) {
  return settings.centre.size() == 0 ? robot.home_pose() : settings.centre;
}

}  // namespace

Configuration random_pose(const ParallelRobot& robot, const RandomPathSettings& settings,
                          RandomGenerator& random) {
  const ConfigurationSpace& space = robot.space();
  PlatformVector away = PlatformVector::Zero(space.dimension());
  draw_in_ball(settings.distance, random, away.head(space.translations()));
  draw_in_ball(settings.rotation, random, away.tail(space.rotations()));
  return space.plus(centre_of(robot, settings), away);
}

bool stays_within(const ParallelRobot& robot, const PlatformPath& path, const RandomPathSettings& settings) {
  Kinematics k;
  for (double time = 0.0; time < path.duration() + step; time += step) {
    const PlatformReference at = path.evaluate(time);
    robot.kinematics(at.pose, at.velocity, k);
    if (!is_inside(robot, k, settings)) return false;
  }
  return true;
}

PlatformPath random_path(const ParallelRobot& robot, const RandomPathSettings& settings, std::uint64_t seed) {
  if (!(settings.pause >= 0.0)) throw SetupError("random path: the pause must not be negative");
  RandomGenerator random(derive_seed(seed, "random path"));
  std::vector<Configuration> poses = {centre_of(robot, settings)};
  double duration = 0.0;
  Effort effort;
  for (int draws = 0; duration < settings.duration; ++draws) {
    if (draws == most_draws) {
      throw SetupError(
          "of " + std::to_string(most_draws) +
          " random poses none can be reached within the robot's limits; lower distance or speed");
    }
    effort.check(settings, duration);
    const Configuration next = random_pose(robot, settings, random);
    ++effort.ways;
    effort.looked_at += time_of_way(robot, poses.back(), next, settings.limits);
    try {
      const PlatformPath way = PlatformPath::through(robot, {poses.back(), next}, settings.limits);
      if (!stays_within(robot, way, settings)) continue;
      duration += way.duration() + (poses.size() > 1 ? settings.pause : 0.0);
    } catch (const SetupError&) {  // out of reach
      continue;
    }
    poses.push_back(next);
    effort.poses = poses.size();
    draws = -1;
  }
  return PlatformPath::through(robot, poses, settings.limits, settings.pause);
}

}  // namespace flinch
