#pragma once

#include <cstdint>

#include "drivers/dds_writer.h"
#include "drivers/wire_header.h"
#include "systems/framework/time.h"
#include "systems/framework/triple_buffer.h"

struct flinch_Header;

namespace flinch {

/// Fills in what a header says of its sender, and the time of sending: now.
void stamp(flinch_Header& header, const SenderIdentity& sender, std::uint32_t number) noexcept;

/// Sends the last sample that a control loop has left, from another thread.
template <class Sample>
class SampleSender {
 public:
  /// Throws SetupError, as DdsWriter.
  SampleSender(const DdsBus& bus, const Topic& topic, const SenderIdentity& sender)
      : sender_(sender), writer_(bus, topic) {}

  /// For the control loop: leaves a sample to be sent; of its header acquired_ns, count and flags.
  void leave(const Sample& sample) noexcept { left_.publish(sample); }

  /// For the sending thread: the robot that the samples name from now on.
  void name_robot(std::uint64_t robot_id) noexcept { sender_.robot_id = robot_id; }

  /// For the sending thread: sends what was left since the last time; as invalid where it was acquired longer
  /// than `longest_age` ago, as after a program has hung.
  void send(Time longest_age = Time::max()) noexcept {
    if (!left_.take(next_)) return;
    stamp(next_.header, sender_, ++number_);
    const bool is_old = Time(next_.header.sent_ns - next_.header.acquired_ns) > longest_age;
    if (is_old) next_.header.flags &= static_cast<std::uint8_t>(~flag_valid);
    writer_.write(&next_);
  }

 private:
  SenderIdentity sender_;
  std::uint32_t number_ = 0;
  Sample next_{};
  TripleBuffer<Sample> left_;
  DdsWriter writer_;
};

}  // namespace flinch
