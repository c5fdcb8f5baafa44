#include "import/motion_correlation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace flinch {

double correlation_with_motion(const std::vector<double>& i, const std::vector<double>& q) {
  double products = 0.0, squares = 0.0, ones = 0.0, mean = 0.0, moved = 0.0;
  std::size_t count = 0;
  constexpr std::size_t span = 5;
  double largest = 0.0;
  for (std::size_t k = span; k + span < q.size(); ++k) {
    const double step = q[k + span] - q[k - span];
    if (std::isfinite(step)) largest = std::max(largest, std::abs(step));
  }
  std::vector<std::pair<double, double>> pairs;
  for (std::size_t k = span; k + span < std::min(q.size(), i.size()); ++k) {
    const double step = q[k + span] - q[k - span];
    if (!std::isfinite(step) || !std::isfinite(i[k]) || std::abs(step) < 0.05 * largest) continue;
    pairs.emplace_back(i[k], step > 0.0 ? 1.0 : -1.0);
    mean += i[k];
    moved += pairs.back().second;
    ++count;
  }
  if (count < 50) return 0.0;
  mean /= static_cast<double>(count);
  moved /= static_cast<double>(count);
  for (const auto& [value, direction] : pairs) {
    products += (value - mean) * (direction - moved);
    squares += (value - mean) * (value - mean);
    ones += (direction - moved) * (direction - moved);
  }
  return squares > 0.0 && ones > 0.0 ? products / std::sqrt(squares * ones) : 0.0;
}

}  // namespace flinch
