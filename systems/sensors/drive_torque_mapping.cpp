#include "systems/sensors/drive_torque_mapping.h"

#include <algorithm>
#include <string>
#include <vector>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/drive_parameters.h"

namespace flinch {
namespace {

std::vector<std::string> problems(const DriveTorqueSettings& settings, const JointVector& constants,
                                  int drives, const std::optional<LowPassSettings>& low_pass) {
  Findings found;
  found.require(constants.size() == drives, "torque_constant has " + std::to_string(constants.size()) +
                                                " entries; the robot has " + std::to_string(drives) +
                                                " drives");
  found.require(constants.allFinite() && (constants.array() > 0.0).all(),
                "torque_constant has an entry that is not positive [Nm/A]");
  found.add_all(problems(settings.cogging, drives));
  found.require(settings.delay.size() == 0 || settings.delay.size() == drives,
                "delay has " + std::to_string(settings.delay.size()) + " entries; the robot has " +
                    std::to_string(drives) + " drives");
  found.require(settings.delay.allFinite() && (settings.delay.array().abs() <= longest_torque_delay).all(),
                "delay has an entry of more than 1 ms, or one that is not finite [s]");
  if (low_pass) found.add_all(problems(*low_pass));
  return found.take();
}

}  // namespace

DriveTorqueMapping::DriveTorqueMapping(const std::shared_ptr<const ParallelRobot>& robot,
                                       const DriveTorqueSettings& settings,
                                       const std::optional<LowPassSettings>& aligned_with)
    : torque_constant_(settings.torque_constant),
      cogging_(settings.cogging),
      delay_(settings.delay),
      sampling_(settings.sampling) {
  if (torque_constant_.size() == 0) {
    torque_constant_ = default_drives(robot->drive_kind(0), robot->drives()).torque_constant;
  }
  throw_if_any(problems(settings, torque_constant_, robot->drives(), aligned_with));
  if (aligned_with) low_pass_.emplace(*aligned_with);
  keep(Every{sampling_.period}, memory_, next_);
}

bool DriveTorqueMapping::is_usable(const DriveReading& reading) const {
  return reading.valid && reading.current.size() == torque_constant_.size() && reading.current.allFinite();
}

DelayedCurrent DriveTorqueMapping::delayed(const DriveReading& reading, const DelayedCurrent& last) const {
  const bool has_last = last.measured.size() > 0;
  if (delay_.size() == 0 || !is_usable(reading) || (has_last && reading.acquired == last.acquired))
    return last;
  DelayedCurrent now{reading.acquired, reading.current, reading.current, {}};
  if (has_last && reading.acquired > last.acquired &&
      !sampling_.interrupted(last.acquired, reading.acquired)) {
    const double interval = to_seconds(reading.acquired - last.acquired);
    now.earlier.front() = last.measured;
    std::copy(last.earlier.begin(), last.earlier.end() - 1, now.earlier.begin() + 1);
    for (Eigen::Index i = 0; i < delay_.size(); ++i) {
      const auto [whole, rest] = in_intervals(delay_[i], interval);
      const JointVector& from = now.earlier[whole];
      if (from.size() == 0) continue;
      const double then = whole == 0 ? now.measured[i] : now.earlier[whole - 1][i];
      now.acting[i] = then - rest * (then - from[i]) / interval;
    }
  }
  return now;
}

PassedCogging DriveTorqueMapping::passed(const JointReading& encoders, const PassedCogging& last) const {
  const auto count = static_cast<int>(torque_constant_.size());
  if (cogging_.is_none() || !encoders.valid || !usable(encoders.active, count)) return last;
  const JointVector here = cogging_.at(encoders.active);
  return {here, 0.5 * (here + (last.here.size() > 0 ? last.here : here))};
}

JointVector DriveTorqueMapping::torque_of(const DriveReading& reading, const DriveTorqueMemory& next) const {
  const JointVector& current = next.current.acting.size() > 0 ? next.current.acting : reading.current;
  JointVector result = torque_constant_.cwiseProduct(current);
  if (next.cogging.mean.size() > 0) result += next.cogging.mean;
  return result;
}

void DriveTorqueMapping::advance(const JointReading& encoders, const DriveReading& reading,
                                 const StationStatus& station, const DriveTorqueMemory& memory, Time now,
                                 DriveTorqueMemory& next) const {
  next = DriveTorqueMemory();
  next.cogging = passed(encoders, memory.cogging);
  if (station.valid && station.braked) return;
  next.current = delayed(reading, memory.current);
  if (!low_pass_) return;
  const bool is_new = is_usable(reading) && (!memory.torque.started || reading.acquired > memory.acquired);
  if (!is_new && sampling_.expired(memory.arrived, now)) return;
  next.acquired = memory.acquired;
  next.arrived = memory.arrived;
  next.torque = memory.torque;
  if (!is_new) return;
  const bool interrupted = sampling_.interrupted(memory.acquired, reading.acquired);
  const double interval = to_seconds(reading.acquired - memory.acquired);
  next.acquired = reading.acquired;
  next.arrived = now;
  next.torque =
      low_pass_->next(interrupted ? LowPassMemory() : memory.torque, torque_of(reading, next), interval);
}

void DriveTorqueMapping::read(const DriveReading& reading, const StationStatus& station,
                              const DriveTorqueMemory& next, DriveTorque& result) const {
  result.acquired = reading.acquired;
  result.valid = is_usable(reading);
  result.braked = station.valid && station.braked;
  if (!result.valid) {
    result.torque.setZero(torque_constant_.size());
  } else if (low_pass_ && next.torque.started) {
    result.torque = next.torque.output;
  } else {
    result.torque = torque_of(reading, next);
  }
}

}  // namespace flinch
