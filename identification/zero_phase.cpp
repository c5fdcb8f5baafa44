#include "identification/zero_phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flinch {
namespace {

/// y_k = b (x_k + 2 x_{k-1} + x_{k-2}) - a1 y_{k-1} - a2 y_{k-2}: the bilinear transform of
/// w^2 / (s^2 + sqrt(2) w s + w^2), its frequency prewarped.
struct Butterworth {
  double b, a1, a2;

  Butterworth(double cutoff, double period) {
    const double w = std::tan(std::numbers::pi * std::min(cutoff * period, 0.49));
    const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * w + w * w);
    b = w * w * norm;
    a1 = 2.0 * (w * w - 1.0) * norm;
    a2 = (1.0 - std::numbers::sqrt2 * w + w * w) * norm;
  }

  /// In place, from the steady state of the first value.
  void run(Eigen::VectorXd& x) const {
    double x1 = x[0], x2 = x[0], y1 = x[0], y2 = x[0];
    for (double& value : x) {
      const double y = b * (value + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
      x2 = x1, x1 = value, y2 = y1, y1 = y;
      value = y;
    }
  }
};

}  // namespace

Eigen::MatrixXd zero_phase(const Eigen::MatrixXd& samples, double cutoff_frequency, double period) {
  const Eigen::Index n = samples.rows();
  if (n < 2) return samples;
  const Butterworth filter(cutoff_frequency, period);
  const auto settling = static_cast<Eigen::Index>(std::ceil(3.0 / (cutoff_frequency * period)));
  const Eigen::Index pad = std::min(n - 1, settling);
  Eigen::MatrixXd result(n, samples.cols());
  for (Eigen::Index c = 0; c < samples.cols(); ++c) {
    Eigen::VectorXd x(n + 2 * pad);
    x.segment(pad, n) = samples.col(c);
    for (Eigen::Index i = 0; i < pad; ++i) {
      x[pad - 1 - i] = 2.0 * samples(0, c) - samples(i + 1, c);
      x[pad + n + i] = 2.0 * samples(n - 1, c) - samples(n - 2 - i, c);
    }
    for (int direction = 0; direction < 2; ++direction) {
      filter.run(x);
      x.reverseInPlace();
    }
    result.col(c) = x.segment(pad, n);
  }
  return result;
}

}  // namespace flinch
