#pragma once

#include <array>
#include <cstddef>

#include "systems/framework/never_allocates.h"
#include "systems/framework/time.h"

namespace flinch {

/// The latest samples of a sensor, to be delivered late: a State. T has a time `acquired`.
template <class T>
class DelayLine {
 public:
  static constexpr std::size_t capacity = 16;
  static constexpr int longest_delay = capacity - 1;  ///< below which all delays are [periods]

  /// Takes a sample later than all before, and forgets the oldest where it holds `capacity`.
  void push(const T& sample) {
    samples_[next_] = sample;
    next_ = (next_ + 1) % capacity;
    if (count_ < capacity) ++count_;
  }

  /// The latest sample acquired no later than `time`; null when there is none.
  const T* latest_until(Time time) const {
    for (std::size_t age = 1; age <= count_; ++age) {
      const T& sample = samples_[(next_ + capacity - age) % capacity];
      if (sample.acquired <= time) return &sample;
    }
    return nullptr;
  }

  /// Whether every sample, taken every `period`, is still held when it is `delay` old.
  static bool can_delay(Time delay, Time period) { return delay < longest_delay * period; }

 private:
  std::array<T, capacity> samples_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

template <class T>
inline constexpr bool never_allocates<DelayLine<T>> = never_allocates<T>;

}  // namespace flinch
