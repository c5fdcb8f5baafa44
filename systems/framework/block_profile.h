#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "systems/framework/monotonic_clock.h"
#include "systems/framework/time.h"

namespace flinch {

class Diagram;
class System;

/// How long each block of a diagram took, tick by tick: its outputs, updates and derivatives together.
/// Measuring costs a reading of the clock a call. Never allocates while the diagram runs.
class BlockProfile {
 public:
  using Now = Time (*)();

  /// `now` may be another clock to try it with.
  explicit BlockProfile(
      const Diagram& diagram, Now now = [] { return MonotonicClock::now(); });

  struct Row {
    std::string path;  ///< of the block in the diagram: "station/encoders"
    Time worst{};      ///< in one tick [ns]
    Time total{};      ///< in all ticks [ns]
  };
  /// A row for each block, the one with the worst tick first.
  std::vector<Row> rows() const;

  /// The ticks that were measured; the rows mean nothing before the first.
  std::int64_t ticks() const { return ticks_; }

  // For Diagram and Simulator.
  void start_calls() { last_ = now_(); }
  void end_call(const System& block);
  void end_tick();

 private:
  struct Entry {
    Row row;
    Time in_this_tick{};
  };
  void collect(const Diagram& diagram, const std::string& prefix);

  Now now_;
  Time last_{};
  std::int64_t ticks_ = 0;
  std::vector<Entry> entries_;
  std::unordered_map<const System*, std::size_t> index_;
};

}  // namespace flinch
