#include "systems/estimators/base_force_observer.h"

#include <cmath>
#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {

BaseForceObserver::BaseForceObserver(std::shared_ptr<const LegBases> bases,
                                     const BaseForceObserverSettings& settings)
    : bases_(std::move(bases)), settings_(settings) {
  if (!bases_) throw SetupError("base forces: this robot has no model of its base joints");
  if (bases_->size() > max_dof) {
    throw SetupError("base forces: " + std::to_string(bases_->size()) + " components are more than the " +
                     std::to_string(max_dof) + " that can be followed");
  }
  if (!(settings_.gain > 0.0)) throw SetupError("base forces: the gain must be positive [1/s]");
}

bool BaseForceObserver::is_usable(const PlatformMotion& motion, const Kinematics& at,
                                  const DriveTorque& drives, const BaseForceReading& reading) const {
  return motion.valid() && at.valid && drives.valid && !drives.braked && drives.torque.allFinite() &&
         reading.valid && reading.force_in_base.size() == bases_->size() && reading.force_in_base.allFinite();
}

void BaseForceObserver::advance(const PlatformMotion& motion, const Kinematics& at, const DriveTorque& drives,
                                const BaseForceReading& reading, const Memory& memory, Time now,
                                Memory& next) const {
  const bool is_new =
      is_usable(motion, at, drives, reading) && (!memory.started || motion.acquired > memory.acquired);
  if (!is_new) {
    const bool lost = drives.braked || settings_.sampling.expired(memory.arrived, now);
    next = lost ? Memory() : memory;
    return;
  }
  const bool continued = memory.started &&
                         !settings_.sampling.interrupted(memory.acquired, motion.acquired) &&
                         memory.force.allFinite();
  next.started = true;
  next.acquired = motion.acquired;
  next.arrived = now;
  next.begun = continued ? memory.begun : now;
  bases_->momentum(at, drives.torque, next.p, next.known);
  next.known += reading.force_in_base;
  if (!continued) {
    next.force.setZero(bases_->size());
    return;
  }
  const double T = to_seconds(motion.acquired - memory.acquired);
  const BaseForces known = 0.5 * (memory.known + next.known);
  const BaseForces unexplained = (next.p - memory.p) / T - known;
  const double a = std::exp(-settings_.gain * T);
  next.force = unexplained + a * (memory.force - unexplained);
}

void BaseForceObserver::read(const Memory& next, Time now, BaseForceEstimate& result) const {
  constexpr double settling_time_constants = 5.0;
  const Time settling =
      settings_.input_settling_time + from_seconds(settling_time_constants / settings_.gain);
  result = BaseForceEstimate();
  result.acquired = next.acquired;
  result.force_in_base.setZero(bases_->size());
  if (!next.started || !next.force.allFinite()) return;
  result.valid = now - next.begun >= settling;
  result.force_in_base = next.force;
}

}  // namespace flinch
