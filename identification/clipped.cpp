#include "identification/clipped.h"

#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

constexpr std::size_t clipped_run = 3;   // samples in a row at the largest value that there is
constexpr double least_clipped = 0.002;  // of all samples

}  // namespace

std::size_t mark_clipped(const Eigen::VectorXd& signal, std::vector<char>& usable) {
  if (signal.size() == 0) return 0;
  const double limit = signal.cwiseAbs().maxCoeff();
  if (limit == 0.0) return 0;
  const auto at_limit = [&](Eigen::Index k) { return std::abs(signal[k]) == limit; };
  std::size_t run = 0, longest = 0, all = 0;
  for (Eigen::Index k = 0; k < signal.size(); ++k) {
    run = at_limit(k) ? run + 1 : 0;
    longest = std::max(longest, run);
    all += at_limit(k) ? 1 : 0;
  }
  if (longest < clipped_run || static_cast<double>(all) < least_clipped * static_cast<double>(signal.size()))
    return 0;
  for (Eigen::Index k = 0; k < signal.size(); ++k) {
    if (at_limit(k)) usable[static_cast<std::size_t>(k)] = 0;
  }
  return all;
}

void widen_unusable(std::vector<char>& usable, std::ptrdiff_t reach) {
  const std::vector<char> before = usable;
  const auto n = static_cast<std::ptrdiff_t>(usable.size());
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    if (before[static_cast<std::size_t>(k)] == 1) continue;
    const auto from = usable.begin() + std::max<std::ptrdiff_t>(0, k - reach);
    std::fill(from, usable.begin() + std::min(n, k + reach + 1), char{0});
  }
}

}  // namespace flinch
