#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "systems/framework/time.h"

namespace flinch {

/// When an inertial measurement unit measures: by a clock that is its own, whatever the ticks are.
struct ImuClockSettings {
  Time period = 1ms;        ///< From sample to sample.
  Time before_tick = 0us;   ///< How long before the tick at zero one is measured; shorter than the period.
  Time jitter = 0us;        ///< By how much the instants are off, at most, either way.
  Time stamp_jitter = 0us;  ///< By how much what is said of them is off besides.
  /// By how much the delay of a sample is off, at most, either way. Who receives it takes the delay for
  /// constant, so what is said of its instant is off as much; no sample overtakes another.
  Time delay_jitter = 0us;
};

/// All that is wrong with `settings`. Samples and stamps must keep their order.
std::vector<std::string> problems(const ImuClockSettings& settings);

/// When each sample was measured, and when it says that it was. How early or late one is depends on the seed
/// and its number alone.
class ImuClock {
 public:
  static constexpr int most_periods = 8;  ///< That one sample may wait for another.

  struct Sample {
    Time measured{};
    Time stamp{};
    Time late{};  ///< By which it comes later than after the delay.
  };

  ImuClock(const ImuClockSettings& settings, std::uint64_t seed) : settings_(settings), seed_(seed) {}

  /// A sample not later than the first one after `time`.
  std::int64_t number_at(Time time) const;
  Sample sample(std::int64_t number) const;

 private:
  Sample alone(std::int64_t number) const;

  ImuClockSettings settings_;
  std::uint64_t seed_;
};

}  // namespace flinch
