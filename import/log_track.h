#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace flinch {

/// The numbers of one column over their instants: NaN where the log has none.
struct LogTrack {
  std::shared_ptr<const std::vector<std::int64_t>> instants;  ///< growing [ns]
  std::vector<double> values;                                 ///< SI
  std::int64_t longest_bridge = 0;                            ///< between rows that are interpolated [ns]

  /// The first of the two rows around an instant, from row `hint` on or before it.
  std::size_t row_before(std::int64_t instant, std::size_t hint) const;
  /// The value at an instant: that of the row which stands there, or between two rows that are not too far
  /// apart; NaN elsewhere. `row` is row_before().
  double at(std::int64_t instant, std::size_t row) const;
};

/// A column whose cells are mostly empty has a rate of its own: its rows alone. One that has a number in most
/// rows keeps them all, and where it has none there is none.
LogTrack log_track(std::shared_ptr<const std::vector<std::int64_t>> instants, std::vector<double> values);

/// Adds full turns so that no step is longer than half of one; how many steps were turned, and the first row
/// of them.
struct Unwrapped {
  std::size_t steps = 0;
  std::size_t first_row = 0;
};
Unwrapped unwrap(std::vector<double>& values, double turn);

}  // namespace flinch
