#pragma once

#include <drivers/idl/flinch.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "drivers/bus_settings.h"
#include "systems/framework/time.h"
#include "tests/support/other_program.h"
#include "tests/support/shared_memory.h"

namespace flinch::test {

/// The last samples of a topic, by whoever sent them. One program adds, others read.
template <class Sample>
struct Track {
  static constexpr std::uint32_t capacity = 16384;
  std::atomic<std::uint32_t> count;
  std::array<Sample, capacity> samples;

  /// The sample with this index; the last `capacity` are there.
  const Sample& operator[](std::uint32_t index) const { return samples[index % capacity]; }
  Sample& next() { return samples[count % capacity]; }
};

/// All that was seen on a bus. Its stamps are of CLOCK_MONOTONIC, which all programs of a machine share.
struct BusLog {
  Track<flinch_StatusSample> status;
  Track<flinch_JointSample> joints;
  Track<flinch_DriveSample> drives;
  Track<flinch_TorqueSample> commands;
  Track<flinch_DriveRequest> requests;
};

/// A program of its own that only listens to a bus.
class BusTap {
 public:
  /// `network`: the name of the network namespace to listen in; empty: ours.
  explicit BusTap(const BusSettings& settings, const std::string& network = "");

  const BusLog& log() const { return *log_; }

 private:
  SharedMemory<BusLog> log_;
  OtherProgram program_;
};

/// Looks every millisecond; returns whether `condition` has come true within `patience`.
bool wait_until(Time patience, const std::function<bool()>& condition);

}  // namespace flinch::test
