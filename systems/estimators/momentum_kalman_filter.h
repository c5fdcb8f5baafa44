#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>

#include "systems/estimators/momentum_estimator.h"

namespace flinch {

/// Noise along one platform coordinate; of a rotation N is Nm.
struct MomentumNoise {
  double momentum_deviation;  ///< of the momentum that is measured, each sample: R is its square [Ns]
  double momentum_density;    ///< Q_p: of what changes the momentum beside known and external forces [N^2 s]
  double force_density;       ///< Q_f: how fast the external force may wander [N^2/s]
};

struct MomentumKalmanFilterSettings {
  /// Q_f = 10 as in [ICRA23] Fig. 6; with this R the poles lie at -71 +- 71 j 1/s.
  MomentumNoise translation{.momentum_deviation = 0.01, .momentum_density = 0.0, .force_density = 10.0};
  /// The same poles, at a tenth of a metre.
  MomentumNoise rotation{.momentum_deviation = 0.001, .momentum_density = 0.0, .force_density = 0.1};
  MomentumInputs inputs;
};

/// Kalman filter of momentum and external wrench, [ICRA23] (14), in each coordinate
///   d/dt (p, F) = (F + s, 0) + w,   y = p + n,   Q = diag(Q_p, Q_f),   R.
/// The wrench has no model, so only innovations of the momentum change it. Between samples T apart it is
/// discretised exactly; the covariance is updated in Joseph's form. It begins with F = 0 and the covariance
/// of the steady state, so its gains are constant until a sample is missing. Observable always.
class MomentumKalmanMethod {
 public:
  struct Memory {
    PlatformVector momentum;
    PlatformVector wrench;
    std::array<Eigen::Matrix2d, max_dof> covariance;  ///< of (p, F) along each coordinate
    double innovation = 1.0;
  };

  /// `translations` coordinates come first, then `rotations`. `period` [s]
  MomentumKalmanMethod(int translations, int rotations, const MomentumKalmanFilterSettings& settings);

  /// Five time constants of the slowest pole in steady state.
  Time settling_time() const { return settling_time_; }
  Memory begin(const PlatformVector& p) const;
  void advance(const Memory& memory, const MomentumStep& step, Memory& next) const;
  void describe(const Memory& memory, WrenchEstimate& estimate) const;

 private:
  const MomentumNoise& noise(int coordinate) const {
    return coordinate < translations_ ? noise_[0] : noise_[1];
  }

  int translations_;
  std::array<MomentumNoise, 2> noise_;
  std::array<Eigen::Matrix2d, 2> steady_covariance_;
  double observability_;
  Time settling_time_;
};

/// The momentum Kalman filter, with the inputs and the validity of `MomentumEstimator`.
class MomentumKalmanFilter final : public MomentumEstimator<MomentumKalmanMethod> {
 public:
  /// Throws SetupError for noise that is not positive.
  MomentumKalmanFilter(const std::shared_ptr<const ParallelRobot>& robot,
                       const MomentumKalmanFilterSettings& settings);
};

}  // namespace flinch
