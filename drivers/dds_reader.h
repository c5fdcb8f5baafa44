#pragma once

#include <atomic>
#include <cstdint>

#include "drivers/dds_bus.h"
#include "drivers/topics.h"

namespace flinch {

/// The samples that have arrived at a reader and wait.
class DdsArrivals {
 public:
  explicit DdsArrivals(std::int32_t reader) : reader_(reader) {}

  /// Copies the next sample into `sample`, a struct of the topic's type. Returns whether there was one.
  bool take(void* sample) noexcept;

 private:
  std::int32_t reader_;
};

/// What a writer has promised with its topic and not kept, since the start.
struct QosMismatch {
  std::uint32_t deadlines = 0;  ///< periods in which no sample came although one was due
  std::uint32_t silences = 0;   ///< how often one did not show in time that it lives, or left
};

/// Receives samples of one topic, each as it arrives.
class DdsReader {
 public:
  /// Is called on a thread of the bus, or of a writer in the same program, never twice at once: takes all
  /// that has arrived.
  using OnData = void (*)(DdsArrivals arrivals, void* owner);

  /// `owner` is handed to `on_data`, which may be called before this returns. Throws SetupError.
  DdsReader(const DdsBus& bus, const Topic& topic, OnData on_data, void* owner);
  DdsReader(const DdsReader&) = delete;  // the bus holds its address
  DdsReader& operator=(const DdsReader&) = delete;
  ~DdsReader() = default;

  /// How many writers send.
  int writers() const noexcept;

  /// From any thread, also that of a control loop.
  QosMismatch qos_mismatch() const noexcept {
    return {deadlines_.load(std::memory_order_relaxed), silences_.load(std::memory_order_relaxed)};
  }

 private:
  struct Listener;

  OnData on_data_;
  void* owner_;
  std::atomic<std::uint32_t> deadlines_ = 0;
  std::atomic<std::uint32_t> silences_ = 0;
  DdsEntity topic_;
  DdsEntity reader_;  // last: goes first, and nothing arrives any more
};

/// How many writers of a topic of this name there are on the bus, also those of another protocol, whose
/// samples no reader of this program gets. For set-up, not for a loop.
int writers_on(const DdsBus& bus, const Topic& topic);

}  // namespace flinch
