#pragma once

#include <algorithm>
#include <concepts>
#include <memory>
#include <utility>

#include "systems/estimators/momentum_sample.h"
#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/sampling.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// How an estimator of the generalised momentum reads its inputs.
struct MomentumInputs {
  TorqueTiming torque_timing = TorqueTiming::sampled;
  Sampling sampling;
  /// How long a velocity that has just begun still adapts: five time constants of the 30 Hz filter.
  Time settling_time = 27ms;
};

/// From one sample of the momentum to the next, T later: dp/dt = s + F_ext.
struct MomentumStep {
  double T;                     ///< [s]
  const PlatformVector& begin;  ///< p at its begin [Ns, Nms]
  const PlatformVector& end;    ///< and at its end
  const PlatformVector& known;  ///< mean of s, as `mean_known_wrench` [N, Nm]
};

/// An observer of F_ext in dp/dt = s + F_ext: what it remembers, how that begins with a first momentum and
/// goes on with each step, and what it says. All of it is mathematics; samples that are missing, late or
/// broken are kept from it.
template <class M>
concept MomentumMethod = requires(const M& method, const PlatformVector& p, const MomentumStep& step,
                                  const typename M::Memory& memory, typename M::Memory& next,
                                  WrenchEstimate& estimate) {
  { method.begin(p) } -> std::same_as<typename M::Memory>;
  method.advance(memory, step, next);
  { memory.wrench } -> std::convertible_to<const PlatformVector&>;
  method.describe(memory, estimate);  // standard deviation and health
  { method.settling_time() } -> std::same_as<Time>;
};

/// What an estimator of the momentum remembers.
template <MomentumMethod Method>
struct MomentumEstimatorMemory {
  MomentumSample last;  ///< not valid: nothing to continue from
  Time arrived{};       ///< tick at which it was read
  Time started{};       ///< tick of the first sample since the last reset
  typename Method::Memory method;
  JointVector drive_torque;
};

/// Estimates the external wrench from the generalised momentum by one of several methods.
///
/// The estimate is valid once the method has settled after the first sample, and not before its inputs have.
/// A tick at which any input is not valid, not finite or not new is skipped: the estimate stays, valid, for
/// the longest hold, and the next sample is integrated over the whole time since the last. After that the
/// method begins anew.
///
/// What closed brakes hold cannot be told from what acts from outside. So at ticks with closed brakes the
/// method begins anew, its estimate is zero, and from then on it tells what has been added since they opened.
template <MomentumMethod Method>
class MomentumEstimator : public System {
  using Memory = MomentumEstimatorMemory<Method>;
  State<Memory> memory_ = state<Memory>("memory");

 public:
  MomentumEstimator(std::shared_ptr<const ParallelRobot> robot, Method method, const MomentumInputs& inputs)
      : robot_(std::move(robot)),
        method_(std::move(method)),
        inputs_(inputs),
        settling_time_(std::max(method_.settling_time(), inputs.settling_time)) {
    keep(Every{inputs_.sampling.period}, memory_, next_);
  }

  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  InputPort<DriveTorque> torque = input<DriveTorque>("torque");

 private:
  Intermediate<MomentumSample> sample_ =
      intermediate<&MomentumEstimator::sample>("sample", platform, kinematics, dynamics, torque);
  Intermediate<Memory> next_ =
      intermediate<&MomentumEstimator::advance>("next", sample_, kinematics, memory_, clock);

 public:
  OutputPort<WrenchEstimate> wrench = output<&MomentumEstimator::read>("wrench", next_, clock);

  const Method& method() const noexcept { return method_; }

 private:
  MomentumSample sample(const PlatformMotion& motion, const Kinematics& at, const Dynamics& model,
                        const DriveTorque& drives) const {
    return momentum_sample(motion, at, model, drives);
  }

  void advance(const MomentumSample& seen, const Kinematics& at, const Memory& memory, Time now,
               Memory& next) const {
    const bool is_new = seen.valid && (!memory.last.valid || seen.acquired > memory.last.acquired);
    if (!is_new) {
      next = inputs_.sampling.expired(memory.arrived, now) ? Memory() : memory;
      return;
    }
    const bool continued = can_continue(memory, seen.acquired);
    const bool explained_by_brakes = seen.braked || memory.last.braked;
    if (continued && !explained_by_brakes) {
      step(memory, seen, next.method);
    } else {
      next.method = method_.begin(seen.p);
    }
    next.drive_torque = at.J_x_qa.transpose() * next.method.wrench;  // [SafePR] (6b)
    next.started = continued ? memory.started : now;
    next.arrived = now;
    next.last = seen;
  }

  bool can_continue(const Memory& memory, Time acquired) const {
    return memory.last.valid && memory.method.wrench.allFinite() &&
           !inputs_.sampling.interrupted(memory.last.acquired, acquired);
  }

  void step(const Memory& memory, const MomentumSample& now, typename Method::Memory& next) const {
    const double T = to_seconds(now.acquired - memory.last.acquired);
    const PlatformVector known = mean_known_wrench(memory.last, now, inputs_.torque_timing);
    method_.advance(memory.method, {T, memory.last.p, now.p, known}, next);
  }

  void read(const Memory& next, Time now, WrenchEstimate& result) const {
    const bool usable = next.last.valid && next.method.wrench.allFinite() && next.drive_torque.allFinite();
    result = WrenchEstimate();
    result.acquired = next.last.acquired;
    result.valid = usable && now - next.started >= settling_time_;
    result.wrench_in_base = usable ? next.method.wrench : PlatformVector::Zero(robot_->dof());
    result.drive_torque = usable ? next.drive_torque : JointVector::Zero(robot_->drives());
    if (usable) method_.describe(next.method, result);
  }

  std::shared_ptr<const ParallelRobot> robot_;
  Method method_;
  MomentumInputs inputs_;
  Time settling_time_;
};

}  // namespace flinch
