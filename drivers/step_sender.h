#pragma once

#include <cstdint>

#include "drivers/sample_sender.h"

namespace flinch {

/// Sends samples of an end in lockstep, at once, as often as it is told: whoever waits for an answer sends
/// again what may have been lost.
template <class Sample>
class StepSender {
 public:
  /// Throws SetupError, as DdsWriter.
  StepSender(const DdsBus& bus, const Topic& topic, const SenderIdentity& sender)
      : sender_(sender), writer_(bus, topic) {}

  /// The robot that the samples name from now on.
  void name_robot(std::uint64_t robot_id) noexcept { sender_.robot_id = robot_id; }

  /// Sends `sample`, which belongs to the tick at `tick` of the simulation; of its header acquired_ns, count
  /// and flags are set.
  void send(Sample sample, Time tick) noexcept {
    stamp(sample.header, sender_, ++number_);
    sample.header.sent_ns = tick.count();
    sample.header.flags |= flag_lockstep;
    writer_.write(&sample);
  }

 private:
  SenderIdentity sender_;
  std::uint32_t number_ = 0;
  DdsWriter writer_;
};

}  // namespace flinch
