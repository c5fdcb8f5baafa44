#pragma once

#include <algorithm>
#include <functional>

#include "plant/rig_dynamics.h"
#include "systems/framework/integrator.h"
#include "systems/robot/forward_dynamics.h"

namespace flinch::test {

/// The rig as a differential equation without a diagram around it, with the work done by drives, by applied
/// wrench and gravity and by contacts, and the work lost to friction, as four more states.
class RigEquation final : public DifferentialEquation {
 public:
  explicit RigEquation(const RigDynamics& rig)
      : applied_wrench(PlatformVector::Zero(rig.robot().dof())),
        step(rig.initial_step()),
        rig_(rig),
        size_(static_cast<std::size_t>(rig.initial_state().size())) {}

  /// Drives, applied wrench and gravity, contacts, friction; after the rig's states.
  static constexpr std::size_t works = 4;
  std::size_t size() const { return size_ + works; }

  DriveAction drives;
  PlatformVector applied_wrench;
  RigStep step;  ///< Of the tick: its chart, its candidates.

  void rates(double, std::span<const double> y, std::span<double> rates) override {
    const RigState state = Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(size_));
    RigState rate(state.size());
    rig_.rates(state, drives, applied_wrench, step, rate);
    std::copy_n(rate.data(), size_, rates.begin());

    RigSnapshot now;
    rig_.snapshot(state, drives, applied_wrench, step, 0.0, now);
    const PlatformVector& velocity = now.velocity;
    Kinematics kinematics;
    Dynamics dynamics;
    rig_.robot().kinematics(now.pose, velocity, kinematics);
    rig_.robot().dynamics(kinematics, dynamics);
    const std::span<double> work = rates.subspan(size_);
    work[0] = drives.torque.size() == 0 ? 0.0 : drives.torque.dot(kinematics.rates.active);
    work[1] = (applied_wrench - dynamics.g_x).dot(velocity);
    work[2] = (now.contacts.obstacle_wrench + now.contacts.self_wrench).dot(velocity);
    work[3] = friction_power(kinematics, dynamics);
  }

 private:
  const RigDynamics& rig_;
  std::size_t size_;
};

}  // namespace flinch::test
