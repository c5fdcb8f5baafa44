#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "plant/narrow_phase.h"
#include "plant/rig_dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/mechanism.h"
#include "systems/robot/motion_equations.h"

namespace flinch {

/// Any mechanism for the inner loop of a simulation: its kinematics and dynamics, and distances of its convex
/// shapes to obstacles and to one another. A planar mechanism lies in the plane z = 0 of the base frame, and
/// contact forces on it stay in that plane.
class GeneralRig {
 public:
  struct Instant {
    Kinematics kinematics;
    MotionEquations equations;
  };

  explicit GeneralRig(const RigSettings& settings);

  bool at(const RigState& state, const RigChart& chart, Instant& now) const noexcept;
  Configuration pose(const RigState& state, const RigChart& chart) const noexcept;
  /// xi' = (p', J_l^-1(xi_r) omega), the rotation counted from the chart's pose; xi' = v elsewhere.
  void coordinate_rates(const RigState& state, const RigChart& chart, RigState& rates) const noexcept;
  double drive_position(const Instant& now, int drive) const noexcept {
    return now.kinematics.joints.active[drive];
  }
  double drive_rate(const Instant& now, int drive) const noexcept {
    return now.kinematics.rates.active[drive];
  }
  /// What the motor of `drive`, which is not even, makes of `torque` where it stands with its leg.
  double torque_ripple(const Instant& now, int drive, double torque) const noexcept {
    return torque_ripple_[static_cast<std::size_t>(drive)].at(drive_position(now, drive), torque);
  }
  PlatformVector acceleration(const Instant& now, const JointVector& torque,
                              const PlatformVector& wrench) const noexcept;
  JointVector drive_accelerations(const Instant& now, const PlatformVector& acceleration) const noexcept {
    return now.kinematics.J_qa_x * acceleration + now.kinematics.dJ_qa_x * now.kinematics.velocity;
  }
  /// Fills joints, loop closure and energy.
  void describe(const Instant& now, RigSnapshot& out) const noexcept;

  Eigen::Vector3d point_velocity(const Instant& now, int body, const Eigen::Vector3d& point) const noexcept;
  PlatformVector wrench(const Instant& now, int body, const Eigen::Vector3d& point,
                        const Eigen::Vector3d& force) const noexcept;
  Eigen::Vector3d point_in_body(const Instant& now, int body, const Eigen::Vector3d& point) const noexcept;
  Eigen::Vector3d point_in_base(const Instant& now, int body, const Eigen::Vector3d& point) const noexcept;

  /// Calls touch(body, obstacle, gap) and meet(body, other body, gap) for the pairs in `candidates`.
  template <class Touch, class Meet>
  void for_each_gap(const Instant& now, const PlacedObstacles& obstacles, const ContactCandidates& candidates,
                    Touch&& touch, Meet&& meet) const noexcept;
  /// The pairs that can touch within `duration` [s] from now: boxes, then exact gaps, against how far the
  /// bodies can move meanwhile. It tells and uses no clearance.
  ContactSearch find_candidates(const Instant& now, const PlacedObstacles& obstacles, double duration,
                                double clearance = 0.0) const noexcept;
  void find_near_pairs(const Instant& now, const PlacedObstacles& obstacles, NearPairs& out) const noexcept;
  SurfaceGap gap(const Instant& now, int body, int obstacle, const PlacedObstacles& obstacles) const noexcept;

  Placement placement(const Instant& now, int body) const noexcept;

 private:
  using Placements = std::array<Placement, max_bodies>;
  using Boxes = std::array<AxisBox, max_bodies>;

  /// Two things that may touch: a body, and another body or an obstacle.
  struct Pair {
    int body;
    int other;
    bool of_obstacle;
  };

  Pair pair(std::size_t number) const noexcept;
  std::size_t pair_count() const noexcept;
  SurfaceGap gap(const Pair& pair, const Placements& bodies, const PlacedObstacles& obstacles) const noexcept;
  SurfaceGap in_space_of_robot(SurfaceGap gap) const noexcept;
  CartesianVector cartesian(const Eigen::Vector3d& v) const noexcept { return v.head(directions_); }
  Eigen::Vector3d in_space(const CartesianVector& v) const noexcept;
  void place_bodies(const Instant& now, Placements& out) const noexcept;
  double greatest_speed(const Instant& now, const Placements& bodies, const Boxes& boxes) const noexcept;

  std::shared_ptr<const Mechanism> robot_;
  int directions_;
  std::vector<std::vector<Solid>> bodies_;
  std::vector<std::vector<Solid>> beside_platform_;  ///< Of each body, what may touch the platform.
  std::vector<Solid> obstacles_;
  std::vector<TorqueRipple> torque_ripple_;
  std::vector<BodyPair> self_pairs_;  ///< None, where the robot's bodies pass through one another.
};

template <class Touch, class Meet>
void GeneralRig::for_each_gap(const Instant& now, const PlacedObstacles& obstacles,
                              const ContactCandidates& candidates, Touch&& touch,
                              Meet&& meet) const noexcept {
  Placements placed;
  std::array<bool, max_bodies> is_placed{};
  const auto place = [&](int body) {
    const auto index = static_cast<std::size_t>(body);
    if (!is_placed[index]) placed[index] = placement(now, body);
    is_placed[index] = true;
  };
  candidates.for_each(pair_count(), [&](std::size_t number) {
    const Pair both = pair(number);
    place(both.body);
    if (!both.of_obstacle) place(both.other);
    const SurfaceGap nearest = gap(both, placed, obstacles);
    if (!(nearest.gap < 0.0)) return;
    if (both.of_obstacle) {
      touch(both.body, both.other, nearest);
    } else {
      meet(both.body, both.other, nearest);
    }
  });
}

}  // namespace flinch
