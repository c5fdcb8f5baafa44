#pragma once

#include <memory>

#include "systems/estimators/momentum_sample.h"
#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/sampling.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

struct MomentumObserverSettings {
  PlatformVector gain;  ///< Diagonal of K_o [1/s]; empty: 20 for each, as in [SafePR] V-A.
  TorqueTiming torque_timing = TorqueTiming::sampled;
  Sampling sampling;
  /// How long a velocity that has just begun still adapts: five time constants of the 30 Hz filter.
  Time input_settling_time = 27ms;
};

/// What the momentum observer remembers.
struct MomentumObserverMemory {
  MomentumSample last;  ///< not valid: nothing to continue from
  Time arrived{};       ///< tick at which it was read
  Time started{};       ///< tick of the first sample since the last reset
  PlatformVector wrench;
  JointVector drive_torque;
};

/// Generalised-momentum observer of the external wrench, [SafePR] (13):
///   F = K_o (p(t) - p(0) - integral of (F_a - beta + F)),   hence   dF/dt = K_o (F_ext - F).
/// Between samples T apart it is solved exactly for constant F_ext, with a = exp(-k_o T) in each component:
///   F_k = a F_{k-1} + (1 - a) ((p_k - p_{k-1}) / T - s_mean),   F_0 = 0,
/// where s_mean is `mean_known_wrench`. Only differences of p enter, so that p(0) is subtracted.
///
/// The estimate is valid from five time constants of the slowest gain after the first sample on, and not
/// before its inputs have settled. A tick at which any input is not valid, not finite or not new is skipped:
/// the estimate stays, valid, for the longest hold, and the next sample is integrated over the whole time
/// since the last. After that the observer starts anew.
///
/// What closed brakes hold cannot be told from what acts from outside. So at ticks with closed brakes the
/// estimate is zero, and from then on it tells what has been added since they opened.
class MomentumObserver final : public System {
  State<MomentumObserverMemory> memory_ = state<MomentumObserverMemory>("memory");

 public:
  /// Throws SetupError unless there is a positive gain for each platform coordinate.
  MomentumObserver(std::shared_ptr<const ParallelRobot> robot, const MomentumObserverSettings& settings);

  const PlatformVector& gain() const noexcept { return gain_; }  ///< Diagonal of K_o [1/s]

  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  InputPort<DriveTorque> torque = input<DriveTorque>("torque");

 private:
  Intermediate<MomentumSample> sample_ =
      intermediate<&MomentumObserver::sample>("sample", platform, kinematics, dynamics, torque);
  Intermediate<MomentumObserverMemory> next_ =
      intermediate<&MomentumObserver::advance>("next", sample_, kinematics, memory_, clock);

 public:
  OutputPort<WrenchEstimate> wrench = output<&MomentumObserver::read>("wrench", next_, clock);

 private:
  MomentumSample sample(const PlatformMotion& motion, const Kinematics& at, const Dynamics& model,
                        const DriveTorque& drives) const;
  void advance(const MomentumSample& sample, const Kinematics& at, const MomentumObserverMemory& memory,
               Time now, MomentumObserverMemory& next) const;
  void read(const MomentumObserverMemory& next, Time now, WrenchEstimate& result) const;
  bool can_continue(const MomentumObserverMemory& memory, Time acquired) const;
  PlatformVector step(const MomentumObserverMemory& memory, const MomentumSample& now) const;

  std::shared_ptr<const ParallelRobot> robot_;
  PlatformVector gain_;
  Time settling_time_;
  TorqueTiming torque_timing_;
  Sampling sampling_;
};

}  // namespace flinch
