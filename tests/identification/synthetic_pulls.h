#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "identification/pull_windows.h"
#include "systems/framework/random.h"
#include "systems/robot/rotation.h"

namespace flinch::test {

/// What is true of synthetic pulls at a robot with three drives in a plane.
struct SyntheticPulls {
  Eigen::Vector3d constant{6.021, 6.6116, 6.7315};  ///< [Nm/A]
  Eigen::Vector3d offset{0.3, -0.2, 0.1};           ///< [Nm]
  Eigen::Vector3d coulomb{0.1, -0.1, 0.05};         ///< [Nm]
  double misalignment = 0.0;                        ///< largest, of each of seven mountings [rad]
  double current_noise = 0.0;                       ///< of the mean of a window [A]
  double torque_noise = 0.0;                        ///< of each window by itself [Nm]
  double cogging = 0.0;                             ///< largest amplitude [Nm]
  double force = 70.0;                              ///< largest [N]
  int pulls = 4;                                    ///< at each mounting
  int windows = 12;                                 ///< of each pull
};

/// Windows as they would be recorded; deterministic by `seed`.
inline std::vector<PullWindow> make(const SyntheticPulls& truth, std::uint64_t seed) {
  RandomGenerator random(seed);
  std::vector<PullWindow> windows;
  const double turn = 2.0 * std::numbers::pi;
  Eigen::Vector3d amplitude, phase;
  for (int i = 0; i < 3; ++i) {
    amplitude[i] = random.uniform(0.0, truth.cogging);
    phase[i] = random.uniform(0.0, turn);
  }
  double time = 0.0;
  for (int m = 0; m < 7; ++m) {
    const double askew = random.uniform(-truth.misalignment, truth.misalignment);
    const Eigen::Matrix3d turned = rotation_matrix(quaternion_exp(Eigen::Vector3d(0.0, 0.0, askew)));
    Eigen::MatrixXd map = Eigen::MatrixXd::Zero(3, 3);
    for (int i = 0; i < 3; ++i) map.row(i) << random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0.0;
    for (int p = 0; p < truth.pulls; ++p) {
      const double direction = turn * (p / 4.0 + random.uniform(0.0, 0.2));
      for (int k = 0; k < truth.windows; ++k, time += 0.1) {
        PullWindow w;
        w.mounting = m;
        w.cluster = m * truth.pulls + p;
        w.time = time;
        const double strength = truth.force * std::sin(std::numbers::pi * (k + 0.5) / truth.windows);
        const Eigen::Vector3d force =
            strength * Eigen::Vector3d(std::cos(direction), std::sin(direction), 0.0);
        w.force = turned.transpose() * force;
        w.force_map = map;
        w.moment_map.setZero(3, 3);
        w.rate = Eigen::Vector3d::Constant(std::cos(turn * time / 10.0) > 0.0 ? 0.1 : -0.1);
        w.model_effort.setZero(3);
        w.position.resize(3);
        w.current.resize(3);
        w.current_deviation = Eigen::Vector3d::Constant(truth.current_noise);
        for (int i = 0; i < 3; ++i) {
          const double position = 0.13 * std::sin(turn * time / 10.0 + i);
          w.position[i] = position;
          const double cogs = amplitude[i] * std::sin(24.0 * position + phase[i]);
          const double torque = -map.row(i).dot(force) + truth.offset[i] +
                                truth.coulomb[i] * (w.rate[i] > 0.0 ? 1.0 : -1.0) - cogs +
                                truth.torque_noise * random.normal();
          w.current[i] = torque / truth.constant[i] + truth.current_noise * random.normal();
        }
        windows.push_back(w);
      }
    }
  }
  return windows;
}

}  // namespace flinch::test
