#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "systems/framework/diagram.h"
#include "systems/framework/place.h"
#include "systems/framework/recording.h"
#include "systems/framework/sample_block.h"
#include "systems/framework/time.h"
#include "systems/framework/unit_table.h"
#include "systems/framework/value_type.h"

namespace flinch {

class Context;

/// Copies the values of chosen ports, tick by tick, into a ring of samples that it allocates beforehand.
/// Ports that show one value, as an exported output and that of the block behind it do, share its rows.
///
/// One thread calls record(). Another may take samples away meanwhile (front() and pop(), as RecordingStream
/// does, which writes them to a file); neither waits for the other. Where nobody does, the ring holds the
/// first `capacity` samples.
class Recorder {
 public:
  /// `paths` name ports of `diagram` (Diagram::taps() lists them). At most `capacity` samples fit; of those
  /// that come while it is full only the number is kept. `units` says what fields mean that give the name of
  /// a quantity as their unit. Throws SetupError for unknown paths, for ports whose type has no fields, and
  /// for quantities that `units` does not have.
  Recorder(const Diagram& diagram, const std::vector<std::string>& paths, std::size_t capacity,
           const UnitTable& units = {}, Every every = Every{});

  /// Records one sample when it is due and there is room. Never allocates, locks or blocks.
  void record(const Context& context);

  /// Forgets all samples. Not while another thread takes them away.
  void clear();

  std::size_t capacity() const { return capacity_; }
  /// Samples in the ring.
  std::size_t samples() const {
    const std::size_t popped = popped_.load(std::memory_order_acquire);
    return pushed_.load(std::memory_order_acquire) - popped;
  }
  /// Samples that did not fit.
  std::int64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

  /// The oldest samples in the ring, as many as lie together in memory; they stay until pop().
  SampleBlock front() const;
  /// Removes the oldest `samples`.
  void pop(std::size_t samples);

  /// What is recorded, without samples.
  Recording description(std::map<std::string, std::string> attributes = {}) const;

  /// All that is in the ring, with `attributes` saying what made it.
  Recording recording(std::map<std::string, std::string> attributes = {}) const;

 private:
  /// One value of a sample.
  struct Channel {
    Place place;
    const ValueType* type;
    std::size_t first;    ///< of its numbers, in a sample
    std::size_t numbers;  ///< of which it consists
  };
  /// One path under which a value is recorded.
  struct Shown {
    Signal signal;  ///< without rows
    std::size_t channel;
  };

  std::size_t channel_of(const Diagram::Tap& tap);
  SampleBlock block(std::size_t first, std::size_t samples) const;

  static constexpr std::size_t cache_line = 64;
  static_assert(std::atomic<std::size_t>::is_always_lock_free &&
                std::atomic<std::int64_t>::is_always_lock_free);

  Every every_;
  std::size_t capacity_;
  std::vector<Channel> channels_;
  std::vector<Shown> shown_;
  std::size_t numbers_ = 0;  ///< of a sample
  std::vector<std::int64_t> time_ns_;
  std::vector<internal::Number> rows_;  ///< a ring: all of a sample lies together, as it is written
  alignas(cache_line) std::atomic<std::size_t> pushed_ = 0;  ///< since the start
  std::atomic<std::int64_t> dropped_ = 0;
  alignas(cache_line) std::atomic<std::size_t> popped_ = 0;
};

/// The paths of all ports of `diagram` that can be recorded, its own inputs included; intermediate results
/// are left out.
std::vector<std::string> recordable_paths(const Diagram& diagram);

}  // namespace flinch
