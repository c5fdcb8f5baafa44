#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "plant/obstacle.h"
#include "systems/framework/never_allocates.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Most contacts and near pairs of which the simulation keeps account at one instant.
inline constexpr int max_touches = 16;

/// Where the surface of a body is nearest to what it may meet, in the base frame.
struct SurfaceGap {
  double gap;              ///< Distance [m]; negative where they penetrate.
  Eigen::Vector3d normal;  ///< Unit vector from the body towards the other.
  Eigen::Vector3d point;   ///< Midway between the surfaces [m].
};

/// One contact of the robot with an obstacle, in the base frame.
struct Touch {
  int body;                        ///< BodyId::index().
  int obstacle;                    ///< Its place in the list of obstacles.
  Eigen::Vector3d point;           ///< Midway between the surfaces, or the point that is held [m].
  Eigen::Vector3d force_on_robot;  ///< [N]
  double depth;                    ///< Of penetration [m].
  bool held = false;               ///< By the grip of a hand, which also pulls.
};

/// All contact forces at one instant, in the base frame. Wrenches are platform wrenches F.
struct ContactForces {
  /// None, of a robot with `dof` coordinates.
  explicit ContactForces(int dof = 0) { clear(dof); }

  void clear(int dof) {
    obstacle_wrench.setZero(dof);
    self_wrench.setZero(dof);
    touch_count = 0;
    self_contact = false;
    self_body = self_other = -1;
    for (Eigen::Vector3d& force : on_obstacle) force.setZero();
  }

  PlatformVector obstacle_wrench;                                    ///< What the obstacles do to the robot.
  PlatformVector self_wrench;                                        ///< What its bodies do to one another.
  std::array<Eigen::Vector3d, max_obstacles> on_obstacle;            ///< What the robot does to each [N].
  std::array<Touch, static_cast<std::size_t>(max_touches)> touches;  ///< The first `touch_count` are used.
  int touch_count = 0;
  bool self_contact = false;
  int self_body = -1, self_other = -1;  ///< BodyId::index() of two that meet: the first pair found.
};

template <>
inline constexpr bool never_allocates<ContactForces> =
    never_allocates<PlatformVector>&& never_allocates<Touch>;

/// How near a body is to an obstacle.
struct NearPair {
  int body = -1;
  int obstacle = -1;
  double gap = 0.0;   ///< [m]; negative where they penetrate.
  double rate = 0.0;  ///< [m/s]
};

/// The nearest pairs of bodies and obstacles, those that are within `near_distance`.
struct NearPairs {
  static constexpr double near_distance = 0.02;  ///< [m] No surface comes nearer by that within a tick.

  std::array<NearPair, static_cast<std::size_t>(max_touches)> pairs{};
  int count = 0;

  /// Takes a pair that is near, in the place of a farther one where there is no room.
  void add(const NearPair& pair);
  /// The pair of this body and obstacle; null where they are not near.
  const NearPair* find(int body, int obstacle) const;
  /// The pair of this obstacle with the least gap; null where none is near.
  const NearPair* nearest_of(int obstacle) const;
};

/// An obstacle at one instant, in the base frame.
struct PlacedObstacle {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d velocity;  ///< [m/s]
};

using PlacedObstacles = std::array<PlacedObstacle, max_obstacles>;

}  // namespace flinch
