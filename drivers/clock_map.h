#pragma once

#include <algorithm>

#include "systems/framework/time.h"

namespace flinch {

/// Tells the times of one steady clock ("there") by another ("here"), from events that are stamped there,
/// when they begin, and here, when they are detected. The delay between is unknown but never negative, so the
/// smallest difference of the two stamps is nearest to the difference of the clocks:
///
///   offset_k = min(offset_{k-1} + drift (t_k - t_{k-1}), here_k - there_k),   drift = 100 ppm
///
/// Its error is the smallest delay, and what the clocks drift apart until a delay is as small again. A late
/// event does not move the offset, so stamps keep their spacing whatever the jitter of arrival.
class ClockMap {
 public:
  void observe(Time there, Time here) noexcept {
    const Time difference = here - there;
    const Time allowed = started_ ? offset_ + (here - last_) / 10'000 : difference;
    offset_ = std::min(allowed, difference);
    last_ = here;
    started_ = true;
  }

  /// The clock there has fallen back by `time`.
  void shift(Time time) noexcept { offset_ += time; }

  /// Whether anything has been observed; the two below mean nothing before.
  bool started() const noexcept { return started_; }
  Time to_here(Time there) const noexcept { return there + offset_; }
  Time to_there(Time here) const noexcept { return here - offset_; }

 private:
  bool started_ = false;
  Time offset_{};
  Time last_{};
};

}  // namespace flinch
