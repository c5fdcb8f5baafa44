#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>

#include "plant/bench_shapes.h"
#include "plant/broad_phase.h"
#include "plant/contact_pairs.h"
#include "plant/hunt_crossley.h"
#include "plant/pylon.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {

inline constexpr std::size_t bench_body_count = 7;

/// One contact of the robot with the pylon, in the base frame.
struct Touch {
  BodyId body;
  Eigen::Vector2d point{0.0, 0.0};           ///< Midway between the two surfaces [m].
  Eigen::Vector2d force_on_robot{0.0, 0.0};  ///< [N]
  double depth = 0.0;                        ///< Of penetration [m].
};

/// All contact forces at one instant. Wrenches are platform wrenches (f_x, f_y, m_z), base frame [N, N, Nm].
struct ContactForces {
  Eigen::Vector3d pylon_wrench{0.0, 0.0, 0.0};    ///< What the pylon does to the robot.
  Eigen::Vector3d self_wrench{0.0, 0.0, 0.0};     ///< What the robot's bodies do to one another.
  Eigen::Vector2d force_on_pylon{0.0, 0.0};       ///< [N]
  std::array<Touch, bench_body_count> touches{};  ///< Of the pylon; the first `touch_count` are used.
  int touch_count = 0;
  bool self_contact = false;
};

/// Distance of each body to the pylon [m], negative where they penetrate, and its rate [m/s], by
/// BodyId::index(). Without a pylon the distances are infinite.
struct PylonGaps {
  std::array<double, bench_body_count> gap = all_bodies(std::numeric_limits<double>::infinity());
  std::array<double, bench_body_count> rate = all_bodies(0.0);

 private:
  static constexpr std::array<double, bench_body_count> all_bodies(double value) {
    return {value, value, value, value, value, value, value};
  }
};

/// Where the bodies of the bench touch the pylon and one another, and with what forces. All functions need a
/// reachable motion; none allocates.
class ContactModel {
 public:
  /// Without a pylon only the robot's bodies touch, and these only with a `link_material`. The robot must be
  /// reachable at its home pose.
  ContactModel(const PlanarRrr& robot, const std::optional<Pylon>& pylon,
               const std::optional<ContactMaterial>& link_material);

  /// The pairs that can touch within `duration` [s] from now: boxes first, then exact gaps, both against how
  /// far the bodies can move meanwhile.
  ContactCandidates candidates(const PlanarMotion& motion, const PylonMotion& pylon,
                               double duration) const noexcept;

  /// Forces of the pairs in `candidates`.
  void forces(const PlanarMotion& motion, const PylonMotion& pylon, ContactCandidates candidates,
              ContactForces& out) const noexcept;

  /// Gaps of all bodies to the pylon.
  void pylon_gaps(const PlanarMotion& motion, const PylonMotion& pylon, PylonGaps& out) const noexcept;

  const BenchShapes& shapes() const { return shapes_; }

 private:
  bool can_touch(const ContactPair& pair, const PlanarMotion& motion, const PylonMotion& pylon, double reach,
                 const BroadPhase::Boxes& boxes) const noexcept;
  void add_touch(const PlanarMotion& motion, const PylonMotion& pylon, BodyId body, const DiscGap& gap,
                 ContactForces& out) const noexcept;
  void add_self_contact(const PlanarMotion& motion, BodyId round, BodyId body, const DiscGap& gap,
                        ContactForces& out) const noexcept;

  BenchShapes shapes_;
  BroadPhase broad_phase_;
  std::optional<HuntCrossley> pylon_law_;
  std::optional<HuntCrossley> link_law_;
};

}  // namespace flinch
