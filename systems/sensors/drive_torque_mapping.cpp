#include "systems/sensors/drive_torque_mapping.h"

#include <string>
#include <vector>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/drive_parameters.h"

namespace flinch {
namespace {

std::vector<std::string> problems(const JointVector& constants, int drives,
                                  const std::optional<LowPassSettings>& low_pass) {
  Findings found;
  found.require(constants.size() == drives, "torque_constant has " + std::to_string(constants.size()) +
                                                " entries; the robot has " + std::to_string(drives) +
                                                " drives");
  found.require(constants.allFinite() && (constants.array() > 0.0).all(),
                "torque_constant has an entry that is not positive [Nm/A]");
  if (low_pass) found.add_all(problems(*low_pass));
  return found.take();
}

}  // namespace

DriveTorqueMapping::DriveTorqueMapping(const std::shared_ptr<const ParallelRobot>& robot,
                                       const DriveTorqueSettings& settings,
                                       const std::optional<LowPassSettings>& aligned_with)
    : torque_constant_(settings.torque_constant), sampling_(settings.sampling) {
  if (torque_constant_.size() == 0) {
    torque_constant_ = default_drives(robot->drive_kind(0), robot->drives()).torque_constant;
  }
  throw_if_any(problems(torque_constant_, robot->drives(), aligned_with));
  if (aligned_with) low_pass_.emplace(*aligned_with);
  keep(Every{sampling_.period}, memory_, next_);
}

bool DriveTorqueMapping::is_usable(const DriveReading& reading) const {
  return reading.valid && reading.current.size() == torque_constant_.size() && reading.current.allFinite();
}

JointVector DriveTorqueMapping::torque_of(const DriveReading& reading) const {
  return torque_constant_.cwiseProduct(reading.current);
}

void DriveTorqueMapping::advance(const DriveReading& reading, const StationStatus& station,
                                 const DriveTorqueMemory& memory, Time now, DriveTorqueMemory& next) const {
  if (!low_pass_) return;
  if (station.valid && station.braked) {
    next = DriveTorqueMemory();
    return;
  }
  const bool is_new = is_usable(reading) && (!memory.torque.started || reading.acquired > memory.acquired);
  if (!is_new) {
    next = sampling_.expired(memory.arrived, now) ? DriveTorqueMemory() : memory;
    return;
  }
  const bool interrupted = sampling_.interrupted(memory.acquired, reading.acquired);
  const double interval = to_seconds(reading.acquired - memory.acquired);
  next.acquired = reading.acquired;
  next.arrived = now;
  next.torque = low_pass_->next(interrupted ? LowPassMemory() : memory.torque, torque_of(reading), interval);
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
    result.torque = torque_of(reading);
  }
}

}  // namespace flinch
