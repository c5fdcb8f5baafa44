#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/history.h"
#include "systems/signals/platform_acceleration.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/sampling.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// What the direct method must know of one instant: F_ext = M_x ddx + rest.
struct DirectSample {
  Time acquired{};
  bool valid = false;
  bool braked = false;
  PlatformMatrix M_x;
  PlatformVector rest;     ///< C_x dx + g_x + F_fr_x - F_a [N, Nm]
  PlatformVector driving;  ///< F_a [N, Nm]
};

/// The external wrench straight from the equation of motion, [RAL25] (5):
///   F_ext = M_x ddx + C_x dx + g_x + F_fr_x - F_a.
/// It has no dynamics of its own; what it lags, the acceleration lags. An acceleration of some milliseconds
/// ago is set against model and torques of then; between two ticks, on the straight line between them,
/// but for the torque, see `driven_share`. So `torque` must not be filtered.
///
/// Valid where acceleration, motion, model and torque are at this tick. Zero while brakes are closed: what
/// they hold cannot be told from what acts from outside.
class DirectMethod final : public System {
  State<History<DirectSample, late_samples>> past_ = state<History<DirectSample, late_samples>>("past");

 public:
  explicit DirectMethod(std::shared_ptr<const ParallelRobot> robot, const Sampling& sampling = {})
      : robot_(std::move(robot)), sampling_(sampling) {}

  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  InputPort<DriveTorque> torque = input<DriveTorque>("torque");
  InputPort<PlatformAcceleration> acceleration = input<PlatformAcceleration>("acceleration");

 private:
  Intermediate<DirectSample> sample_ =
      intermediate<&DirectMethod::sample>("sample", platform, kinematics, dynamics, torque);

 public:
  OutputPort<WrenchEstimate> wrench =
      output<&DirectMethod::estimate>("wrench", acceleration, kinematics, sample_, past_);

 private:
  Update remember_ = update<&DirectMethod::remember>(past_, sample_);

  DirectSample sample(const PlatformMotion& motion, const Kinematics& at, const Dynamics& model,
                      const DriveTorque& drives) const;
  void remember(const DirectSample& fresh, History<DirectSample, late_samples>& past) const;
  void estimate(const PlatformAcceleration& measured, const Kinematics& at, const DirectSample& fresh,
                const History<DirectSample, late_samples>& past, WrenchEstimate& result) const;

  std::shared_ptr<const ParallelRobot> robot_;
  Sampling sampling_;
};

}  // namespace flinch
