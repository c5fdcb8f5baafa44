#include "identification/spikes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "identification/robust_mean.h"
#include "systems/foundation/median.h"

namespace flinch {
namespace {

constexpr double limit = 5.0;  // deviations
constexpr int passes = 2;      // the second finds what hid beside greater ones

/// Which samples are far from their neighbours.
std::vector<char> far_ones(const Eigen::VectorXd& x, int reach) {
  const Eigen::Index n = x.size();
  Eigen::VectorXd middle(n), scatter(n);
  std::vector<double> near;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index from = std::max<Eigen::Index>(0, k - reach);
    const Eigen::Index to = std::min(n, k + reach + 1);
    near.assign(x.begin() + from, x.begin() + to);
    middle[k] = median(near);
    for (double& value : near) value -= middle[k];
    scatter[k] = robust_deviation(near);
  }
  const double usual = median({scatter.begin(), scatter.end()});
  std::vector<char> far(static_cast<std::size_t>(n), 0);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (std::abs(x[k] - middle[k]) > limit * std::max(scatter[k], usual))
      far[static_cast<std::size_t>(k)] = 1;
  }
  return far;
}

/// Straight lines across those that are far; at the ends the nearest good one.
void bridge(const std::vector<char>& far, Eigen::Ref<Eigen::VectorXd> x) {
  const auto n = static_cast<Eigen::Index>(far.size());
  for (Eigen::Index k = 0; k < n; ++k) {
    if (far[static_cast<std::size_t>(k)] == 0) continue;
    Eigen::Index end = k;
    while (end < n && far[static_cast<std::size_t>(end)] == 1) ++end;
    const double before = k > 0 ? x[k - 1] : (end < n ? x[end] : 0.0);
    const double after = end < n ? x[end] : before;
    const double steps = static_cast<double>(end - k + 1);
    for (Eigen::Index i = k; i < end; ++i)
      x[i] = before + (after - before) * static_cast<double>(i - k + 1) / steps;
    k = end;
  }
}

}  // namespace

std::size_t remove_spikes(Eigen::MatrixXd& signals, int reach) {
  std::size_t removed = 0;
  for (Eigen::Index c = 0; c < signals.cols(); ++c) {
    for (int pass = 0; pass < passes; ++pass) {
      const std::vector<char> far = far_ones(signals.col(c), reach);
      bridge(far, signals.col(c));
      removed += static_cast<std::size_t>(std::count(far.begin(), far.end(), 1));
    }
  }
  return removed;
}

}  // namespace flinch
