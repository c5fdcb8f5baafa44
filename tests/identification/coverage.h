#pragma once

#include <cmath>

#include "identification/torque_constant_fit.h"
#include "tests/identification/synthetic_pulls.h"

namespace flinch::test {

/// How many of the 95 % intervals of torque constants cover the truth.
struct Coverage {
  int covered = 0;
  int intervals = 0;

  double share() const { return static_cast<double>(covered) / intervals; }
};

/// Of calibrations from random pulls: cogging of up to 0.5 Nm, 2 degrees of misalignment, noise.
inline Coverage cover(int calibrations, std::uint64_t first_seed) {
  const SyntheticPulls truth{
      .misalignment = 0.035, .current_noise = 0.003, .torque_noise = 0.05, .cogging = 0.5, .windows = 15};
  Coverage coverage;
  for (int trial = 0; trial < calibrations; ++trial) {
    const auto windows = make(truth, first_seed + static_cast<std::uint64_t>(trial));
    const TorqueConstantFit fit = fit_torque_constants(windows, 7, Eigen::Vector3d::Constant(6.1), {});
    const Eigen::VectorXd deviation = fit_uncertainty(fit.linear).deviation;
    for (int i = 0; i < 3; ++i) {
      coverage.covered += std::abs(fit.constant[i] - truth.constant[i]) <= 1.96 * deviation[3 * i] ? 1 : 0;
      ++coverage.intervals;
    }
  }
  return coverage;
}

}  // namespace flinch::test
