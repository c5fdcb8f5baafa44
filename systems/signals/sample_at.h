#pragma once

#include <optional>

#include "systems/signals/history.h"
#include "systems/signals/sampling.h"

namespace flinch {

/// The sample of an instant: that which was acquired at `time`, or `between(around, time)` of the two around
/// it; of an instant before all that are known, the oldest. None after the newest, which may be `fresh`, and
/// where the two are too far apart.
template <class Sample, std::size_t size, class Between>
std::optional<Sample> sample_at(Time time, const History<Sample, size>& past, const Sample* fresh,
                                const Sampling& sampling, Between&& between) {
  const Around<Sample> around = past.around(time, fresh);
  if (around.after == nullptr) return std::nullopt;
  if (around.before == nullptr || around.before == around.after) return *around.after;
  if (sampling.interrupted(around.before->acquired, around.after->acquired)) return std::nullopt;
  return between(around, time);
}

}  // namespace flinch
