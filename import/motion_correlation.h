#pragma once

#include <vector>

namespace flinch {

/// Correlation, -1 to 1, of a current with the direction in which its drive moves, which friction follows; 0
/// where it moves in fewer than 50 rows or in one direction only.
double correlation_with_motion(const std::vector<double>& current, const std::vector<double>& position);

}  // namespace flinch
