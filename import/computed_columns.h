#pragma once

#include <span>
#include <string>
#include <vector>

namespace flinch {

/// The numbers of a column of a log, by rows; NaN where there is none.
struct ColumnNumbers {
  std::string name;
  std::vector<double> values;
};

/// A column that follows from others, so it tells nothing that they do not.
struct ComputedColumn {
  std::string name;
  std::vector<std::string> from;
  enum class How { function, multiple, rate } how = How::function;

  /// "a function of 'phi', 'psi'".
  std::string words() const;
};

/// Which candidates were computed by who wrote the log. One is a function of the drives' positions where it
/// has the same number, to the last bit, whenever they come back to theirs: a sensor of its own would not.
/// One is a multiple of a column, or its rate, where a straight line through both leaves nothing but the
/// rounding of a text. `seconds`: of the rows. Of a column that hardly changes nothing is said.
std::vector<ComputedColumn> computed_columns(std::span<const ColumnNumbers> drives,
                                             std::span<const ColumnNumbers> others,
                                             std::span<const ColumnNumbers> candidates,
                                             std::span<const double> seconds);

}  // namespace flinch
