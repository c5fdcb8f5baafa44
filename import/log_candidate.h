#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "import/column_roles.h"

namespace flinch {

/// Rows of a log by which its columns are guessed.
inline constexpr std::size_t looked_at_rows = 20'000;

/// A column of a log with its first rows.
struct LogCandidate {
  std::size_t column = 0;
  NamedRole role;
  std::vector<double> values;

  double largest() const {
    double most = 0.0;
    for (const double value : values) most = std::max(most, std::isfinite(value) ? std::abs(value) : 0.0);
    return most;
  }
};

}  // namespace flinch
