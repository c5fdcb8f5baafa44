#include "systems/estimators/momentum_observer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr double settling_time_constants = 5.0;

std::vector<std::string> problems(const PlatformVector& gain, int dof) {
  std::vector<std::string> found;
  if (gain.size() != dof) {
    found.push_back("gain has " + std::to_string(gain.size()) + " entries; the robot has " +
                    std::to_string(dof) + " platform coordinates");
  }
  if (!gain.allFinite() || (gain.array() <= 0.0).any()) {
    found.emplace_back("gain has an entry that is not positive [1/s]");
  }
  return found;
}

}  // namespace

MomentumObserver::MomentumObserver(std::shared_ptr<const ParallelRobot> robot,
                                   const MomentumObserverSettings& settings)
    : robot_(std::move(robot)),
      gain_(settings.gain.size() == 0 ? PlatformVector::Constant(robot_->dof(), 20.0).eval() : settings.gain),
      torque_timing_(settings.torque_timing),
      sampling_(settings.sampling) {
  throw_if_any(problems(gain_, robot_->dof()));
  settling_time_ =
      std::max(from_seconds(settling_time_constants / gain_.minCoeff()), settings.input_settling_time);
  keep(Every{sampling_.period}, memory_, next_);
}

MomentumSample MomentumObserver::sample(const PlatformMotion& motion, const Kinematics& at,
                                        const Dynamics& model, const DriveTorque& drives) const {
  return momentum_sample(motion, at, model, drives);
}

void MomentumObserver::advance(const MomentumSample& seen, const Kinematics& at,
                               const MomentumObserverMemory& memory, Time now,
                               MomentumObserverMemory& next) const {
  const bool is_new = seen.valid && (!memory.last.valid || seen.acquired > memory.last.acquired);
  if (!is_new) {
    next = sampling_.expired(memory.arrived, now) ? MomentumObserverMemory() : memory;
    return;
  }
  const bool continued = can_continue(memory, seen.acquired);
  const bool unexplained_by_brakes = !seen.braked && !memory.last.braked;
  next.wrench = continued && unexplained_by_brakes ? step(memory, seen) : PlatformVector::Zero(robot_->dof());
  next.drive_torque = at.J_x_qa.transpose() * next.wrench;  // [SafePR] (6b)
  next.started = continued ? memory.started : now;
  next.arrived = now;
  next.last = seen;
}

bool MomentumObserver::can_continue(const MomentumObserverMemory& memory, Time acquired) const {
  return memory.last.valid && memory.wrench.allFinite() &&
         !sampling_.interrupted(memory.last.acquired, acquired);
}

PlatformVector MomentumObserver::step(const MomentumObserverMemory& memory, const MomentumSample& now) const {
  const double T = to_seconds(now.acquired - memory.last.acquired);
  const PlatformVector a = (-T * gain_).array().exp();
  const PlatformVector dp = (now.p - memory.last.p) / T;
  const PlatformVector unexplained = dp - mean_known_wrench(memory.last, now, torque_timing_);
  return unexplained + a.cwiseProduct(memory.wrench - unexplained);
}

void MomentumObserver::read(const MomentumObserverMemory& next, Time now, WrenchEstimate& result) const {
  const bool usable = next.last.valid && next.wrench.allFinite() && next.drive_torque.allFinite();
  result.acquired = next.last.acquired;
  result.valid = usable && now - next.started >= settling_time_;
  result.wrench_in_base = usable ? next.wrench : PlatformVector::Zero(robot_->dof());
  result.drive_torque = usable ? next.drive_torque : JointVector::Zero(robot_->drives());
}

}  // namespace flinch
