#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "plant/planar_shapes.h"
#include "plant/rig_dynamics.h"
#include "plant/turning_wave.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {

/// The planar 3-RRR for the inner loop of a simulation: motion, forward dynamics and distances to round
/// obstacles in closed form and fixed sizes. Its coordinates xi are the pose (x, y, phi) itself. What is
/// given and returned in space lies in the plane z = 0 of the base frame.
class PlanarRig {
 public:
  using Instant = PlanarMotion;

  /// The robot of `settings` must be a PlanarRrr, all obstacles round.
  explicit PlanarRig(const RigSettings& settings);

  const PlanarRrr& robot() const noexcept { return *robot_; }
  const PlanarShapes& shapes() const noexcept { return shapes_; }
  Disc disc(int obstacle, const PlacedObstacle& placed) const noexcept;

  /// The instant of `state`; false where it is out of reach.
  bool at(const RigState& state, const RigChart&, Instant& now) const noexcept {
    robot_->motion(state.head<3>(), state.segment<3>(3), now);
    return now.reachable;
  }
  Configuration pose(const RigState& state, const RigChart&) const noexcept { return state.head<3>(); }
  void coordinate_rates(const RigState& state, const RigChart&, RigState& rates) const noexcept {
    rates.head<3>() = state.segment<3>(3);
  }
  double drive_position(const Instant& now, int drive) const noexcept;
  /// What the motor of `drive`, which is not even, makes of `torque` where it stands with its leg.
  double torque_ripple(const Instant& now, int drive, double torque) const noexcept;
  double drive_rate(const Instant& now, int drive) const noexcept {
    return now.legs[static_cast<std::size_t>(drive)].qa_rate;
  }
  Eigen::Vector3d acceleration(const Instant& now, const JointVector& torque,
                               const PlatformVector& wrench) const noexcept {
    return robot_->acceleration(now, torque.head<3>(), wrench.head<3>());
  }
  JointVector drive_accelerations(const Instant& now, const PlatformVector& acceleration) const noexcept {
    return robot_->drive_accelerations(now, acceleration.head<3>());
  }
  /// Fills joints, loop closure and energy.
  void describe(const Instant& now, RigSnapshot& out) const noexcept;

  Eigen::Vector3d point_velocity(const Instant& now, int body, const Eigen::Vector3d& point) const noexcept;
  Eigen::Vector3d wrench(const Instant& now, int body, const Eigen::Vector3d& point,
                         const Eigen::Vector3d& force) const noexcept {
    return contact_wrench(now, BodyId::from_index(body), point.head<2>(), force.head<2>());
  }
  Eigen::Vector3d point_in_body(const Instant& now, int body, const Eigen::Vector3d& point) const noexcept;
  Eigen::Vector3d point_in_base(const Instant& now, int body, const Eigen::Vector3d& point) const noexcept;

  /// Calls touch(body, obstacle, gap) and meet(body, other body, gap) for the pairs in `candidates`.
  template <class Touch, class Meet>
  void for_each_gap(const Instant& now, const PlacedObstacles& obstacles, const ContactCandidates& candidates,
                    Touch&& touch, Meet&& meet) const noexcept;
  /// The pairs that can touch within `duration` [s] from now: boxes first, then exact gaps, both against how
  /// far the bodies can move meanwhile. None while the `clearance` of the search before lasts.
  ContactSearch find_candidates(const Instant& now, const PlacedObstacles& obstacles, double duration,
                                double clearance = 0.0) const noexcept;
  void find_near_pairs(const Instant& now, const PlacedObstacles& obstacles, NearPairs& out) const noexcept;
  SurfaceGap gap(const Instant& now, int body, int obstacle, const PlacedObstacles& obstacles) const noexcept;

 private:
  std::size_t pair_count() const noexcept {
    return planar_self_pairs + planar_pairs_of_obstacle * rounds_.size();
  }
  /// cos and sin of the drive's position.
  Eigen::Vector2d drive_direction(const Instant& now, int drive) const noexcept;
  SurfaceGap surface_gap(const DiscGap& gap, BodyId body) const noexcept;
  double least_gap(const Instant& now, const PlanarPair& pair, const Disc& disc) const noexcept;

  std::shared_ptr<const PlanarRrr> robot_;
  std::array<Eigen::Vector2d, 3> base_directions_;  ///< From which the drive angles count.
  PlanarShapes shapes_;
  std::vector<Sphere> rounds_;  ///< one an obstacle
  bool links_meet_;
  std::vector<TorqueRipple> torque_ripple_;
  std::vector<TorqueRippleBy<TurningHarmonic>> turning_torque_;  ///< The same, where all repeat each turn.
};

template <class Touch, class Meet>
void PlanarRig::for_each_gap(const Instant& now, const PlacedObstacles& obstacles,
                             const ContactCandidates& candidates, Touch&& touch, Meet&& meet) const noexcept {
  candidates.for_each(pair_count(), [&](std::size_t number) {
    const PlanarPair pair = planar_pair(number);
    if (pair.round == PlanarPair::Round::obstacle) {
      const Disc obstacle = disc(pair.which, obstacles[static_cast<std::size_t>(pair.which)]);
      flinch::for_each_gap(shapes_, pair, now, obstacle, [&](BodyId body, const DiscGap& gap) {
        if (gap.gap < 0.0) touch(body.index(), pair.which, surface_gap(gap, body));
      });
    } else if (links_meet_) {
      const BodyId other = round_body(pair);
      flinch::for_each_gap(shapes_, pair, now, shapes_.joint(pair, now),
                           [&](BodyId body, const DiscGap& gap) {
                             if (gap.gap < 0.0) meet(body.index(), other.index(), surface_gap(gap, body));
                           });
    }
  });
}

}  // namespace flinch
