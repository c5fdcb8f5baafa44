#include "systems/estimators/momentum_observer.h"

#include <cmath>
#include <string>
#include <vector>

#include "systems/estimators/differenced_noise.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr double settling_time_constants = 5.0;

std::vector<std::string> problems(const PlatformVector& gain, int dof) {
  std::vector<std::string> found;
  if (gain.size() != dof) {
    found.push_back("gain has " + std::to_string(gain.size()) + " entries; the robot has " +
                    std::to_string(dof) + " platform coordinates");
  }
  if (!gain.allFinite() || (gain.array() <= 0.0).any()) {
    found.emplace_back("gain has an entry that is not positive [1/s]");
  }
  return found;
}

/// The method that `settings` ask for. Throws SetupError.
FirstOrderMomentumMethod method_of(const ParallelRobot& robot, const MomentumObserverSettings& settings) {
  PlatformVector gain = settings.gain;
  if (gain.size() == 0) gain.setConstant(robot.dof(), 20.0);
  throw_if_any(problems(gain, robot.dof()));
  const double T = to_seconds(settings.sampling.period);
  const int translations = robot.space().translations();
  PlatformVector deviation(gain.size());
  for (int i = 0; i < deviation.size(); ++i) {
    const double a = std::exp(-T * gain[i]);
    const double of_momentum =
        i < translations ? settings.deviation.translation : settings.deviation.rotation;
    deviation[i] = differenced_noise(a, T) * of_momentum;
  }
  return FirstOrderMomentumMethod(gain, deviation);
}

}  // namespace

Time FirstOrderMomentumMethod::settling_time() const {
  return from_seconds(settling_time_constants / gain_.minCoeff());
}

void FirstOrderMomentumMethod::advance(const Memory& memory, const MomentumStep& step, Memory& next) const {
  const PlatformVector a = (-step.T * gain_).array().exp();
  const PlatformVector unexplained = (step.end - step.begin) / step.T - step.known;
  next.wrench = unexplained + a.cwiseProduct(memory.wrench - unexplained);
}

MomentumObserver::MomentumObserver(const std::shared_ptr<const ParallelRobot>& robot,
                                   const MomentumObserverSettings& settings)
    : MomentumEstimator(robot, method_of(*robot, settings),
                        {settings.torque_timing, settings.sampling, settings.input_settling_time}) {}

}  // namespace flinch
