#pragma once

#include <array>
#include <cstddef>

#include "systems/framework/time.h"

namespace flinch {

/// The two samples of a signal between which an instant lies; both are one where it is that of a sample.
template <class Sample>
struct Around {
  const Sample* before = nullptr;
  const Sample* after = nullptr;

  bool known() const { return before != nullptr && after != nullptr; }
  /// How far `time` lies on the way from `before` to `after`, 0 to 1.
  double share(Time time) const {
    if (before == after) return 1.0;
    return to_seconds(time - before->acquired) / to_seconds(after->acquired - before->acquired);
  }
};

/// As many ticks of 0.25 ms as a sensor on the platform may be late: 16 ms.
inline constexpr std::size_t late_samples = 64;

/// The last samples of a signal, at most `size`, in the order of their acquisition.
template <class Sample, std::size_t size>
struct History {
  std::array<Sample, size> samples;
  std::size_t count = 0;
  std::size_t next = 0;  ///< where the next one goes

  /// Forgets the oldest where there is no room. One that is not newer than the newest is not taken.
  void push(const Sample& sample) {
    if (count > 0 && sample.acquired <= newest().acquired) return;
    samples[next] = sample;
    next = (next + 1) % size;
    if (count < size) ++count;
  }
  const Sample& newest() const { return back(0); }
  /// The one that `age` others came after; below `count`.
  const Sample& back(std::size_t age) const { return samples[(next + size - 1 - age) % size]; }

  /// The oldest sample that was acquired at `time` or later; none: null.
  const Sample* first_from(Time time) const {
    const Sample* found = nullptr;
    for (std::size_t age = 0; age < count && back(age).acquired >= time; ++age) found = &back(age);
    return found;
  }
  /// The newest sample that was acquired before `time`; none: null.
  const Sample* last_before(Time time) const {
    for (std::size_t age = 0; age < count; ++age) {
      if (back(age).acquired < time) return &back(age);
    }
    return nullptr;
  }
  /// Those around `time`, with `fresh` as one more, later than all; null: there is none.
  Around<Sample> around(Time time, const Sample* fresh = nullptr) const {
    const Sample* after = first_from(time);
    if (after == nullptr && fresh != nullptr && fresh->acquired >= time) after = fresh;
    if (after != nullptr && after->acquired == time) return {after, after};
    return {last_before(time), after};
  }
};

}  // namespace flinch
