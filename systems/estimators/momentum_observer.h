#pragma once

#include <memory>

#include "systems/estimators/momentum_deviation.h"
#include "systems/estimators/momentum_estimator.h"

namespace flinch {

struct MomentumObserverSettings {
  PlatformVector gain;  ///< Diagonal of K_o [1/s]; empty: 20 for each, as in [SafePR] V-A.
  TorqueTiming torque_timing = TorqueTiming::sampled;
  Sampling sampling;
  /// How long a velocity that has just begun still adapts: five time constants of the 30 Hz filter.
  Time input_settling_time = 27ms;
  MomentumDeviation deviation{};
};

/// Generalised-momentum observer of the external wrench, [SafePR] (11) and (13):
///   F = K_o (p(t) - p(0) - integral of (F_a - beta + F)),   hence   dF/dt = K_o (F_ext - F).
/// Between samples T apart it is solved exactly for constant F_ext, with a = exp(-k_o T) in each component:
///   F_k = a F_{k-1} + (1 - a) ((p_k - p_{k-1}) / T - s_mean),   F_0 = 0,
/// where s_mean is `mean_known_wrench`. Only differences of p enter, so that p(0) is subtracted. White noise
/// of deviation sigma_p in p makes sigma_F = (1 - a) (2 / (1 + a))^(1/2) sigma_p / T.
class FirstOrderMomentumMethod {
 public:
  struct Memory {
    PlatformVector wrench;
  };

  /// `gain`: diagonal of K_o [1/s]. `deviation` of F, from the noise of the momentum [N, Nm]; empty: unknown.
  explicit FirstOrderMomentumMethod(PlatformVector gain, PlatformVector deviation = {})
      : gain_(std::move(gain)), deviation_(std::move(deviation)) {}

  const PlatformVector& gain() const noexcept { return gain_; }
  /// Five time constants of the slowest gain.
  Time settling_time() const;
  Memory begin(const PlatformVector& p) const { return {PlatformVector::Zero(p.size())}; }
  void advance(const Memory& memory, const MomentumStep& step, Memory& next) const;
  void describe(const Memory&, WrenchEstimate& estimate) const { estimate.standard_deviation = deviation_; }

 private:
  PlatformVector gain_, deviation_;
};

/// The momentum observer, with the inputs and the validity of `MomentumEstimator`.
class MomentumObserver final : public MomentumEstimator<FirstOrderMomentumMethod> {
 public:
  /// Throws SetupError unless there is a positive gain for each platform coordinate.
  MomentumObserver(const std::shared_ptr<const ParallelRobot>& robot,
                   const MomentumObserverSettings& settings);

  const PlatformVector& gain() const noexcept { return method().gain(); }  ///< Diagonal of K_o [1/s]
};

}  // namespace flinch
