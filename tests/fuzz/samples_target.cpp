// Samples from the bus, as they are once Cyclone DDS has copied them: whose they are, whether they count, and
// what they say.
#include <drivers/idl/flinch.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "drivers/sample_admission.h"
#include "drivers/wire_conversion.h"
#include "tests/fuzz/fuzz_target.h"

namespace flinch::test {
namespace {

template <class Sample>
Sample sample_of(std::string_view bytes) {
  Sample sample{};
  std::memcpy(&sample, bytes.data(), std::min(bytes.size(), sizeof sample));
  return sample;
}

void expect(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

bool has_at_most_six(Eigen::Index size) { return size >= 0 && size <= 6; }

/// Each kind of sample out of the same bytes.
void convert(std::string_view bytes) {
  JointReading joints;
  from_wire(sample_of<flinch_JointSample>(bytes), joints);
  expect(has_at_most_six(joints.active.size()) && has_at_most_six(joints.passive.size()), "joints");
  DriveReading drives;
  from_wire(sample_of<flinch_DriveSample>(bytes), drives);
  expect(has_at_most_six(drives.current.size()), "drives");
  ImuReading imu;
  from_wire(sample_of<flinch_ImuSample>(bytes), imu);
  ForceTorqueReading force_torque;
  from_wire(sample_of<flinch_ForceTorqueSample>(bytes), force_torque);
  StationStatus status;
  from_wire(sample_of<flinch_StatusSample>(bytes), status);
  TorqueCommand torque;
  from_wire(sample_of<flinch_TorqueSample>(bytes), torque);
  expect(has_at_most_six(torque.torque.size()), "torques");
  BrakeCommand brake;
  from_wire(sample_of<flinch_TorqueSample>(bytes), brake);
}

/// One sample after the other, each with the time until it arrives.
void try_samples(std::string_view bytes) {
  constexpr std::size_t size = sizeof(flinch_StatusSample) + 8;
  SampleAdmission admission({.robot = 7, .begins_neutral = true, .once = true});
  Time now = 1s;
  for (; bytes.size() >= sizeof(flinch_Header) + 8; bytes.remove_prefix(std::min(bytes.size(), size))) {
    std::uint32_t wait_us = 0;
    std::memcpy(&wait_us, bytes.data(), 4);
    now += std::chrono::microseconds(wait_us);
    const std::string_view sample = bytes.substr(8);
    const auto header = sample_of<flinch_Header>(sample);
    if (admission.judge(header, now, bytes[4] % 2 == 0) == Admission::admitted) {
      expect(header.version == protocol_version && header.robot == 7 && header.session != 0, "admitted");
      admission.to_own_clock(Time(header.sent_ns));
      admission.to_own_clock(Time(header.acquired_ns));
    }
    convert(sample);
  }
}

std::vector<std::string> samples_seeds() {
  std::string bytes;
  for (std::uint32_t number = 1; number <= 3; ++number) {
    JointReading reading;
    reading.valid = true;
    reading.active = JointVector::Constant(3, 0.5);
    reading.passive = JointVector::Constant(3, 0.25);
    reading.passive_valid = true;
    flinch_JointSample sample{};
    to_wire(reading, sample);
    sample.header.sent_ns = 1'000'000 * number;
    sample.header.session = 5;
    sample.header.robot = 7;
    sample.header.number = number;
    sample.header.version = protocol_version;
    std::string part(sizeof(flinch_StatusSample) + 8, '\0');
    part[1] = 4;  // about a millisecond
    std::memcpy(part.data() + 8, &sample, std::min(sizeof sample, part.size() - 8));
    bytes += part;
  }
  return {bytes};
}

}  // namespace

const FuzzTarget samples_target{"samples", try_samples, samples_seeds};

}  // namespace flinch::test
