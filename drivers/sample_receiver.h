#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "drivers/dds_reader.h"
#include "drivers/sample_admission.h"
#include "systems/framework/bounded_queue.h"
#include "systems/framework/monotonic_clock.h"
#include "systems/framework/sample_signal.h"
#include "systems/framework/triple_buffer.h"

namespace flinch {

/// An admitted sample with its times in the own monotonic clock.
template <class Sample>
struct ReceivedSample {
  Sample sample{};
  Time arrived{};
  Time sent{};      ///< by the sender's stamp; too late by the smallest delay on the way
  Time acquired{};  ///< likewise
};

/// Keeps each value until it is taken, in order, where TripleBuffer keeps the last. Of values that nobody
/// takes the seventeenth and later are dropped.
template <class T>
class SampleQueue {
 public:
  void publish(const T& value) noexcept { queue_.push(value); }
  bool take(T& value) noexcept { return queue_.pop(value); }

 private:
  BoundedQueue<T, 16> queue_;
};

/// Receives samples of one topic, admits or refuses each as it arrives, and keeps the last admitted one for a
/// control loop, which takes it without waiting; or, with SampleQueue, each of them.
template <class Sample, template <class> class Keep = TripleBuffer>
class SampleReceiver {
 public:
  /// Whether a sample asks for nothing: see AdmissionSettings::begins_neutral.
  using IsNeutral = bool (*)(const Sample&);

  /// `arrived`, where given, is notified of each admitted sample. Throws SetupError, as DdsReader.
  SampleReceiver(const DdsBus& bus, const Topic& topic, const AdmissionSettings& admission,
                 IsNeutral is_neutral = nullptr, SampleSignal* arrived = nullptr)
      : is_neutral_(is_neutral),
        arrived_(arrived),
        robots_(admission.robots),
        admission_(admission),
        reader_(bus, topic, &SampleReceiver::receive, this) {}

  /// Copies the kept sample if there is one that was not taken before. For one thread.
  bool take(ReceivedSample<Sample>& received) noexcept { return kept_.take(received); }

  /// How many samples met with `verdict`.
  std::uint32_t count(Admission verdict) const noexcept {
    return counts_[static_cast<std::size_t>(verdict)].load(std::memory_order_relaxed);
  }
  std::uint32_t refused() const noexcept {
    std::uint32_t sum = 0;
    for (const auto& count : counts_) sum += count.load(std::memory_order_relaxed);
    return sum - count(Admission::admitted);
  }

  /// How many samples were lost on the way, by their numbers.
  std::uint32_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

  /// How many writers send.
  int writers() const noexcept { return reader_.writers(); }
  QosMismatch qos_mismatch() const noexcept { return reader_.qos_mismatch(); }

 private:
  static void receive(DdsArrivals arrivals, void* self) {
    auto& receiver = *static_cast<SampleReceiver*>(self);
    ReceivedSample<Sample>& next = receiver.next_;
    while (arrivals.take(&next.sample)) receiver.judge(next);
  }

  void judge(ReceivedSample<Sample>& next) noexcept {
    next.arrived = MonotonicClock::now();
    const bool neutral = is_neutral_ == nullptr || is_neutral_(next.sample);
    const Admission verdict = admission_.judge(next.sample.header, next.arrived, neutral);
    counts_[static_cast<std::size_t>(verdict)].fetch_add(1, std::memory_order_relaxed);
    lost_.store(admission_.missed(), std::memory_order_relaxed);
    note_name(next.sample, verdict);
    if (verdict != Admission::admitted) return;
    next.sent = admission_.to_own_clock(Time(next.sample.header.sent_ns));
    next.acquired = admission_.to_own_clock(Time(next.sample.header.acquired_ns));
    kept_.publish(next);
    if (arrived_ != nullptr) arrived_->notify();
  }

  /// Of every robot that a station could command, whichever it commands.
  void note_name(const Sample& sample, Admission verdict) noexcept {
    if constexpr (requires { sample.robot_name; }) {
      if (robots_ == nullptr) return;
      if (verdict == Admission::other_version || verdict == Admission::other_description) return;
      robots_->note_name(sample.header.robot_id, sample.robot_name);
    }
  }

  IsNeutral is_neutral_;
  SampleSignal* arrived_;
  RobotSelection* robots_;
  SampleAdmission admission_;  // this and next_: only where samples arrive
  ReceivedSample<Sample> next_;
  Keep<ReceivedSample<Sample>> kept_;
  std::array<std::atomic<std::uint32_t>, admission_count> counts_{};
  std::atomic<std::uint32_t> lost_{0};
  DdsReader reader_;  // last
};

}  // namespace flinch
