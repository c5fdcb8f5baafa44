#include "systems/estimators/sliding_mode_observer.h"

#include <cmath>

#include "systems/estimators/chain_observability.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"

namespace flinch {
namespace {

const SlidingModeObserverSettings& checked(const SlidingModeObserverSettings& settings) {
  Findings found;
  found.positive("force_rate", settings.force_rate, "N/s");
  found.positive("moment_rate", settings.moment_rate, "Nm/s");
  found.positive("damping", settings.damping, "1/s");
  found.positive("substeps", settings.substeps);
  throw_if_any(found.take());
  return settings;
}

/// Root of the mean square of what the method takes for a wrench in a coordinate where there is nothing but
/// white noise of `deviation` in the momentum.
double deviation_in_trial(const SlidingModeMethod& method, double T, double deviation, double settled) {
  RandomGenerator random(1);
  const PlatformVector none = PlatformVector::Zero(1);
  PlatformVector before = none, now = none;
  SlidingModeMethod::Memory memory = method.begin(none), next;
  double squares = 0.0;
  const int skipped = static_cast<int>(settled / T), counted = 500;
  for (int k = 0; k < skipped + counted; ++k) {
    now[0] = deviation * random.normal();
    method.advance(memory, {T, before, now, none}, next);
    if (k >= skipped) squares += next.wrench[0] * next.wrench[0];
    memory = next;
    before = now;
  }
  return std::sqrt(squares / counted);
}

}  // namespace

SlidingModeMethod::Gains::Gains(double L, double damping)
    : T1(1.5 * std::sqrt(L)),
      T2(damping),
      S1(1.1 * L),
      S2(1.1 * (8.0 * S1 + 9.0 * T1 * T1) * T2 * T2 / (4.0 * S1)),
      layer(1e-4 / 3000.0 * L) {}

SlidingModeMethod::SlidingModeMethod(int translations, const SlidingModeObserverSettings& settings)
    : translations_(translations),
      gains_{Gains(settings.force_rate, settings.damping), Gains(settings.moment_rate, settings.damping)},
      substep_(to_seconds(settings.inputs.sampling.period) / settings.substeps),
      settling_time_(settings.convergence_time),
      observability_(chain_observability<2>()) {
  const double T = to_seconds(settings.inputs.sampling.period), settled = to_seconds(settling_time_);
  const SlidingModeMethod rotation(*this, 0), translation(*this, 1);
  deviation_ = {deviation_in_trial(translation, T, settings.deviation.translation, settled),
                deviation_in_trial(rotation, T, settings.deviation.rotation, settled)};
}

void SlidingModeMethod::describe(const Memory& memory, WrenchEstimate& estimate) const {
  estimate.standard_deviation.resize(memory.wrench.size());
  for (int i = 0; i < static_cast<int>(memory.wrench.size()); ++i)
    estimate.standard_deviation[i] = deviation_[i < translations_ ? 0 : 1];
  estimate.health.observability = observability_;
}

void SlidingModeMethod::advance(const Memory& memory, const MomentumStep& step, Memory& next) const {
  next = memory;
  const int steps = std::max(1, static_cast<int>(std::lround(step.T / substep_)));
  const double h = step.T / steps;
  for (int i = 0; i < static_cast<int>(step.end.size()); ++i) {
    const Gains& g = gains_[i < translations_ ? 0 : 1];
    const double rate = (step.end[i] - step.begin[i]) / step.T;
    double& p = next.momentum[i];
    double& F = next.wrench[i];
    for (int k = 0; k < steps; ++k) {
      const double e = p - (step.begin[i] + k * h * rate);
      const double sgn = std::tanh(e / g.layer);
      F -= h * (g.S1 * sgn + g.S2 * e);  // first, so that the new one acts on p: stable without damping too
      p += h * (step.known[i] + F - g.T1 * std::sqrt(std::abs(e)) * sgn - g.T2 * e);
    }
  }
}

SlidingModeObserver::SlidingModeObserver(const std::shared_ptr<const ParallelRobot>& robot,
                                         const SlidingModeObserverSettings& settings)
    : MomentumEstimator(robot, SlidingModeMethod(robot->space().translations(), checked(settings)),
                        settings.inputs) {}

}  // namespace flinch
