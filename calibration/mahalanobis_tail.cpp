#include "calibration/mahalanobis_tail.h"

#include <algorithm>
#include <cmath>

#include "calibration/chi_square_quantile.h"

namespace flinch {

void MahalanobisTail::add(double distance, int drives) {
  if (!std::isfinite(distance)) return;
  const double square = distance * distance;
  robots_.back().count += 1.0;
  robots_.back().squares += square;
  fourth_ += square * square;
  drives_ = drives;
}

void MahalanobisTail::begin_robot() {
  is_one_ = false;
  if (robots_.back().count > 0.0) robots_.emplace_back();
}

/// E[chi^4] / E[chi^2]^2 is (n + 2) / n for chi-square of n degrees, and 1 + variation times that for a
/// variance that varies.
double MahalanobisTail::variation() const {
  double count = 0.0, squares = 0.0;
  for (const Robot& robot : robots_) {
    count += robot.count;
    squares += robot.squares;
  }
  if (squares == 0.0) return 0.0;
  const double of_chi_square = 1.0 + 2.0 / drives_;
  return count * fourth_ / (squares * squares) / of_chi_square - 1.0;
}

double MahalanobisTail::between_robots() const {
  double robots = 0.0, mean = 0.0, second = 0.0;
  for (const Robot& robot : robots_) {
    if (robot.count == 0.0) continue;
    const double of_robot = robot.squares / robot.count;
    robots += 1.0;
    mean += of_robot;
    second += of_robot * of_robot;
  }
  if (robots < 2.0 || mean == 0.0) return 0.0;
  mean /= robots;
  return (second / robots - mean * mean) / (mean * mean) * robots / (robots - 1.0);
}

double MahalanobisTail::power(double confidence) const {
  const auto is_seen = [](const Robot& robot) { return robot.count > 0.0; };
  const auto robots = static_cast<int>(std::count_if(robots_.begin(), robots_.end(), is_seen));
  if (!is_one_ && robots < 2) return least_power;
  const double between = between_robots();
  const double of_each = (1.0 + variation()) / (1.0 + between) - 1.0;
  double at_most = 0.0;  // that robots differ
  if (between > 0.0) at_most = between * (robots - 1) / chi_square_quantile(robots - 1, 1.0 - confidence);
  return std::clamp(2.0 - 5.0 * (std::max(of_each, 0.0) + at_most), least_power, 2.0);
}

}  // namespace flinch
