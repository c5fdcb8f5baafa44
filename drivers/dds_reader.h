#pragma once

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

 private:
  static void arrived(std::int32_t reader, void* self);

  OnData on_data_;
  void* owner_;
  DdsEntity topic_;
  DdsEntity reader_;  // last: goes first, and nothing arrives any more
};

}  // namespace flinch
