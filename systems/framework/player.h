#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "systems/framework/recorded_values.h"
#include "systems/framework/system.h"

namespace flinch {

/// Plays one recorded port back: at each tick its output is, bit for bit, the value recorded at that time.
/// Between samples it holds the last one; before the first and after the last its output is a default T, for
/// which flinch's values say that they are not valid.
template <Recordable T>
class Player final : public System {
 public:
  /// Throws SetupError when the recording has no signal `path` or its columns are not those of T.
  Player(const Recording& recording, const std::string& path)
      : period_(recording.period), time_ns_(recording.time_ns) {
    const RecordedValues<T> values = read<T>(recording, path);
    values_.reserve(values.size());
    for (std::size_t k = 0; k < values.size(); ++k) values_.push_back(values[k]);
  }

  OutputPort<T> played = output<&Player::play>("played", clock);

 private:
  T play(Time now) const {
    const auto later = std::upper_bound(time_ns_.begin(), time_ns_.end(), now.count());
    if (later == time_ns_.begin()) return T{};
    if (later == time_ns_.end() && now.count() >= time_ns_.back() + period_.count()) return T{};
    return values_[static_cast<std::size_t>(later - time_ns_.begin()) - 1];
  }

  Time period_;
  std::vector<std::int64_t> time_ns_;
  std::vector<T> values_;
};

}  // namespace flinch
