#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "systems/framework/time.h"

namespace flinch {

/// What is worth knowing of many durations. Least, mean and most are exact; a quantile is never too small,
/// and at most 1/32 too large.
struct DurationSummary {
  std::int64_t count = 0;
  Time min{};
  Time mean{};
  Time p50{};
  Time p99{};
  Time p99_9{};
  Time max{};
};

/// Counts durations in bins whose width grows with the duration: 32 an octave, from 1 ns to 68 s (longer ones
/// share the last bin). Negative durations count as zero. Never allocates.
class DurationHistogram {
 public:
  void add(Time duration);

  std::int64_t count() const { return count_; }

  /// Nothing as long as there is no duration.
  std::optional<DurationSummary> summary() const;

 private:
  static constexpr int bins = 1024;

  static std::size_t bin(std::int64_t ns);
  static std::int64_t largest_in(std::size_t bin);
  /// The smallest bin limit that at least the share `q` of all durations does not exceed.
  Time quantile(double q) const;

  std::array<std::int64_t, bins> counts_{};
  std::int64_t count_ = 0;
  Time sum_{};
  Time min_ = Time::max();
  Time max_{};
};

}  // namespace flinch
