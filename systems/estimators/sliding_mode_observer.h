#pragma once

#include <array>
#include <memory>

#include "systems/estimators/momentum_deviation.h"
#include "systems/estimators/momentum_estimator.h"

namespace flinch {

struct SlidingModeObserverSettings {
  double force_rate = 3000.0;  ///< L: how fast a force may change and still be followed [N/s]
  double moment_rate = 100.0;  ///< the same of a moment [Nm/s]
  double damping = 20.0;       ///< T2, of the linear part [1/s]
  int substeps = 10;           ///< steps of the observer in a sampling period
  /// After which the estimate has followed a force that it found when it began.
  Time convergence_time = 100ms;
  MomentumDeviation deviation;
  MomentumInputs inputs;
};

/// Second-order sliding-mode observer of the momentum, [ICRA23] (15), in each coordinate with e = p^ - p
///   dp^/dt = s + F - T1 |e|^(1/2) sgn(e) - T2 e,   dF/dt = -S1 sgn(e) - S2 e.
/// e and F - F_ext reach zero in finite time as long as |dF_ext/dt| <= L. The paper prints no gains; these
/// are those of the super-twisting algorithm, T1 = 1.5 L^(1/2), S1 = 1.1 L, and for the linear part the
/// sufficient S2 > (8 S1 + 9 T1^2) T2^2 / (4 S1).
///
/// Between samples the observer makes several steps, in which the momentum is interpolated: that takes away
/// nearly all chatter. In a narrow layer sgn(e) passes smoothly through zero.
///
/// How uncertain the estimate is under white noise of the momentum has no closed form: a trial with half a
/// second of it tells, once for each kind of coordinates.
class SlidingModeMethod {
 public:
  struct Memory {
    PlatformVector momentum;
    PlatformVector wrench;
  };

  /// `translations` coordinates come first.
  SlidingModeMethod(int translations, const SlidingModeObserverSettings& settings);

  Time settling_time() const { return settling_time_; }
  Memory begin(const PlatformVector& p) const { return {p, PlatformVector::Zero(p.size())}; }
  void advance(const Memory& memory, const MomentumStep& step, Memory& next) const;
  void describe(const Memory& memory, WrenchEstimate& estimate) const;

 private:
  /// Another with as many translations.
  SlidingModeMethod(const SlidingModeMethod& other, int translations) : SlidingModeMethod(other) {
    translations_ = translations;
  }

  /// Of one kind of coordinates.
  struct Gains {
    Gains(double rate, double damping);
    double T1, T2, S1, S2;
    double layer;  ///< where sgn is half way through [Ns, Nms]
  };

  int translations_;
  std::array<Gains, 2> gains_;
  double substep_;  // the longest [s]
  Time settling_time_;
  double observability_;
  std::array<double, 2> deviation_{};  ///< of a force and of a moment [N, Nm]
};

/// The sliding-mode observer, with the inputs and the validity of `MomentumEstimator`.
class SlidingModeObserver final : public MomentumEstimator<SlidingModeMethod> {
 public:
  /// Throws SetupError for settings that are not positive.
  SlidingModeObserver(const std::shared_ptr<const ParallelRobot>& robot,
                      const SlidingModeObserverSettings& settings);
};

}  // namespace flinch
