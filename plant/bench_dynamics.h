#pragma once

#include <Eigen/Core>

#include "plant/bench_settings.h"
#include "plant/contact_model.h"
#include "plant/drive_action.h"
#include "plant/pylon.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {

/// The continuous state: pose, velocity and, where the pylon's mounting is compliant, the pylon's
/// displacement [m] and velocity [m/s]: 6 or 10 numbers.
using BenchState = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 10, 1>;

/// Everything about the bench at one instant. Wrenches and forces in the base frame.
struct BenchSnapshot {
  PlanarMotion motion;  ///< Unless it is reachable nothing else means anything.
  PylonMotion pylon;
  ContactForces contacts;
  PylonGaps gaps;
  Eigen::Vector3d applied_wrench{0.0, 0.0, 0.0};   ///< [N, N, Nm]
  Eigen::Vector3d acceleration{0.0, 0.0, 0.0};     ///< [m/s^2, m/s^2, rad/s^2]
  Eigen::Vector2d pylon_acceleration{0.0, 0.0};    ///< [m/s^2]
  Eigen::Vector2d force_on_pylon_mount{0.0, 0.0};  ///< What the pylon does to the base below it [N].
};

/// The bench as an ordinary differential equation in platform coordinates:
///   M_x ddx + C_x dx + F_fr = J_qa,x^T tau_a + F_contact + F_applied.  [SafePR] (4)
/// It is regular at type-II singularities. Where a leg would have to stretch beyond its reach the bench
/// stands still and its motion is not reachable. Immutable: one object serves many threads.
class BenchDynamics {
 public:
  /// Throws SetupError with all problems.
  explicit BenchDynamics(const BenchSettings& settings);

  const PlanarRrr& robot() const { return robot_; }
  const ContactModel& contacts() const { return contacts_; }
  const BenchSettings& settings() const { return settings_; }

  BenchState initial_state() const;

  /// The time derivative of `state`, with the forces of the contacts in `candidates`.
  void rates(const BenchState& state, const DriveAction& drives, const Eigen::Vector3d& applied_wrench,
             ContactCandidates candidates, BenchState& rates) const noexcept;

  /// The same, all that lies behind it, and all contacts.
  void snapshot(const BenchState& state, const DriveAction& drives, const Eigen::Vector3d& applied_wrench,
                BenchSnapshot& out) const noexcept;

  /// Contacts that are possible within `duration` [s] from `state` on.
  ContactCandidates candidates(const BenchState& state, double duration) const noexcept;

 private:
  void solve(const BenchState& state, const DriveAction& drives, ContactCandidates candidates,
             BenchSnapshot& out) const noexcept;
  bool pylon_moves() const { return pylon_moves_; }
  PylonMotion pylon_motion(const BenchState& state) const noexcept;
  Eigen::Vector3d brake_torque(const PlanarMotion& motion) const noexcept;

  BenchSettings settings_;
  PlanarRrr robot_;
  ContactModel contacts_;
  Pylon pylon_;
  bool pylon_moves_ = false;
};

}  // namespace flinch
