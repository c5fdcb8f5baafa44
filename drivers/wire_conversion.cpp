#include "drivers/wire_conversion.h"

#include <drivers/idl/flinch.h>

#include "drivers/wire_header.h"

namespace flinch {
namespace {

/// A sample with nothing in it but its header.
template <class Sample>
void begin(Sample& sample, Time acquired, bool valid, Eigen::Index count = 0) {
  sample = Sample{};
  sample.header.acquired_ns = acquired.count();
  sample.header.count = static_cast<std::uint8_t>(count);
  sample.header.flags = valid ? flag_valid : std::uint8_t{0};
}

bool has(const flinch_Header& header, std::uint8_t flag) { return (header.flags & flag) != 0; }

bool has_joints(const flinch_Header& header) { return header.count >= 1 && header.count <= max_dof; }

JointVector first_of(const double (&entries)[max_dof], int count) {
  return Eigen::Map<const Eigen::Matrix<double, max_dof, 1>>(entries).head(count);
}
JointVector first_of(const double (&entries)[max_dof], const flinch_Header& header) {
  return first_of(entries, has_joints(header) ? header.count : 0);
}

/// How many passive angles a joint sample has; none where it says that there are more than can be.
int passive_count(const flinch_Header& header) {
  const int count = (header.flags >> passive_count_bit) & 7;
  return count <= max_dof ? count : 0;
}

void copy(const JointVector& vector, double (&entries)[max_dof], Eigen::Index count) {
  for (Eigen::Index i = 0; i < std::min(count, vector.size()); ++i) entries[i] = vector[i];
}

}  // namespace

void to_wire(const JointReading& reading, flinch_JointSample& sample) noexcept {
  const Eigen::Index count = reading.active.size();
  begin(sample, reading.acquired, reading.valid, count);
  if (reading.passive_valid) sample.header.flags |= flag_passive_valid;
  sample.header.flags |= static_cast<std::uint8_t>(reading.passive.size() << passive_count_bit);
  copy(reading.active, sample.active, count);
  copy(reading.passive, sample.passive, reading.passive.size());
}

void from_wire(const flinch_JointSample& sample, JointReading& reading) noexcept {
  reading.acquired = Time(sample.header.acquired_ns);
  reading.valid = has(sample.header, flag_valid) && has_joints(sample.header);
  reading.passive_valid = has(sample.header, flag_passive_valid) && has_joints(sample.header);
  reading.active = first_of(sample.active, sample.header);
  reading.passive = first_of(sample.passive, passive_count(sample.header));
}

void to_wire(const DriveReading& reading, flinch_DriveSample& sample) noexcept {
  begin(sample, reading.acquired, reading.valid, reading.current.size());
  copy(reading.current, sample.current, reading.current.size());
}

void from_wire(const flinch_DriveSample& sample, DriveReading& reading) noexcept {
  reading.acquired = Time(sample.header.acquired_ns);
  reading.valid = has(sample.header, flag_valid) && has_joints(sample.header);
  reading.current = first_of(sample.current, sample.header);
}

void to_wire(const ImuReading& reading, flinch_ImuSample& sample) noexcept {
  begin(sample, reading.acquired, reading.valid);
  Eigen::Map<Eigen::Vector3d>(sample.angular_velocity) = reading.angular_velocity;
  Eigen::Map<Eigen::Vector3d>(sample.specific_force) = reading.specific_force;
}

void from_wire(const flinch_ImuSample& sample, ImuReading& reading) noexcept {
  reading.acquired = Time(sample.header.acquired_ns);
  reading.valid = has(sample.header, flag_valid);
  reading.angular_velocity = Eigen::Map<const Eigen::Vector3d>(sample.angular_velocity);
  reading.specific_force = Eigen::Map<const Eigen::Vector3d>(sample.specific_force);
}

void to_wire(const ForceTorqueReading& reading, flinch_ForceTorqueSample& sample) noexcept {
  begin(sample, reading.acquired, reading.valid);
  Eigen::Map<Eigen::Vector3d>(sample.force_in_base) = reading.force_in_base;
  Eigen::Map<Eigen::Vector3d>(sample.moment_in_base) = reading.moment_in_base;
}

void from_wire(const flinch_ForceTorqueSample& sample, ForceTorqueReading& reading) noexcept {
  reading.acquired = Time(sample.header.acquired_ns);
  reading.valid = has(sample.header, flag_valid);
  reading.force_in_base = Eigen::Map<const Eigen::Vector3d>(sample.force_in_base);
  reading.moment_in_base = Eigen::Map<const Eigen::Vector3d>(sample.moment_in_base);
}

void to_wire(const StationStatus& status, flinch_StatusSample& sample) noexcept {
  begin(sample, status.acquired, status.valid);
  sample.enabled = status.enabled;
  sample.braked = status.braked;
  sample.fault = status.fault;
}

void from_wire(const flinch_StatusSample& sample, StationStatus& status) noexcept {
  status.acquired = Time(sample.header.acquired_ns);
  status.valid = has(sample.header, flag_valid);
  status.enabled = sample.enabled != 0;
  status.braked = sample.braked != 0;
  status.fault = sample.fault != 0;
}

void to_wire(const TorqueCommand& command, const BrakeCommand& brake, flinch_TorqueSample& sample) noexcept {
  begin(sample, command.computed, command.valid, command.torque.size());
  if (brake.engage) sample.header.flags |= flag_engage_brake;
  copy(command.torque, sample.torque, command.torque.size());
}

void to_wire(const ContactDetection& detection, const ReactionState& reaction, Time now,
             flinch_ContactEvent& event) noexcept {
  const Eigen::Index count = detection.wrench_in_base.size();
  begin(event, now, detection.valid, count);
  event.level = static_cast<std::uint8_t>(detection.level);
  event.reaction = static_cast<std::uint8_t>(reaction.mode);
  copy(detection.wrench_in_base, event.wrench_in_base, count);
}

void from_wire(const flinch_TorqueSample& sample, TorqueCommand& command) noexcept {
  command.computed = Time(sample.header.acquired_ns);
  command.valid = has(sample.header, flag_valid) && has_joints(sample.header);
  command.torque = first_of(sample.torque, sample.header);
}

void from_wire(const flinch_TorqueSample& sample, BrakeCommand& brake) noexcept {
  brake.engage = has(sample.header, flag_engage_brake);
}

bool asks_for_nothing(const flinch_TorqueSample& sample) noexcept {
  return !has(sample.header, flag_valid) || has(sample.header, flag_engage_brake);
}

}  // namespace flinch
