#include "identification/dominant_wave.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/foundation/median.h"
#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

double explained(const std::vector<WaveSample>& samples, double rate) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double sum = 0.0, squares = 0.0;
  for (const WaveSample& sample : samples) {
    const double phase = rate * sample.position;
    const double blurred = rate * sample.blur * rate * sample.blur;
    const double seen = sample.factor / (1.0 + blurred * blurred);  // by zero_phase
    const Eigen::Vector3d a(1.0, seen * std::sin(phase), seen * std::cos(phase));
    H += a * a.transpose();
    b += sample.left * a;
    sum += sample.left;
    squares += sample.left * sample.left;
  }
  const double scatter = squares - sum * sum / static_cast<double>(samples.size());
  return 1.0 - (squares - b.dot(H.ldlt().solve(b))) / scatter;
}

}  // namespace

Wave dominant_wave(const std::vector<WaveSample>& samples, double fewest, double least) {
  if (samples.size() < 30) return {};
  std::vector<double> steps;
  double low = samples.front().position, high = low;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    low = std::min(low, samples[k].position);
    high = std::max(high, samples[k].position);
    if (k > 0) steps.push_back(std::abs(samples[k].position - samples[k - 1].position));
  }
  const double range = high - low;
  const double most = 0.5 * std::numbers::pi / std::max(median(steps), 1e-3 * range);
  // Of n values of noise the best of a thousand waves explains 14 / n.
  Wave best{0.0, std::numbers::pi / range, 2.0 * std::numbers::pi * fewest / range,
            std::max(least, 30.0 / static_cast<double>(samples.size()))};
  for (double rate = best.least; rate < most; rate += 0.25 / range) {
    const double share = explained(samples, rate);
    if (share > best.explained) best.rate = rate, best.explained = share;
  }
  return best.rate > 0.0 ? best : Wave();
}

}  // namespace flinch
