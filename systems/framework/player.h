#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"
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
      : period_(recording.period), time_ns_(recording.time_ns), values_(recording.samples()) {
    const Signal& signal = recording.signal(path);
    check_layout(signal);
    for (std::size_t k = 0; k < values_.size(); ++k) {
      if (!read_row(signal.rows.data() + k * signal.layout.numbers, values_[k])) {
        throw SetupError("the signal '" + path +
                         "' has a sample with an impossible size; the recording is broken");
      }
    }
  }

  OutputPort<T> played = output<&Player::play>("played", clock);

 private:
  T play(Time now) const {
    const auto later = std::upper_bound(time_ns_.begin(), time_ns_.end(), now.count());
    if (later == time_ns_.begin()) return T{};
    if (later == time_ns_.end() && now.count() >= time_ns_.back() + period_.count()) return T{};
    return values_[static_cast<std::size_t>(later - time_ns_.begin()) - 1];
  }

  static void check_layout(const Signal& signal) {
    const RowLayout expected = row_layout<T>();
    const auto same = [](const Field& a, const Field& b) {
      return a.name == b.name && a.kind == b.kind && a.capacity == b.capacity && a.resizable == b.resizable;
    };
    if (!std::equal(expected.fields.begin(), expected.fields.end(), signal.layout.fields.begin(),
                    signal.layout.fields.end(), same)) {
      throw SetupError("the signal '" + signal.path +
                       "' was recorded with other fields than this version of flinch has");
    }
  }

  Time period_;
  std::vector<std::int64_t> time_ns_;
  std::vector<T> values_;
};

}  // namespace flinch
