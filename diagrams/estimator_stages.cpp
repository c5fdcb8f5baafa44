#include "diagrams/estimator_stages.h"

#include "diagrams/contact_control_settings.h"

namespace flinch {
namespace {

/// An estimator of the momentum: one of its own inputs is all that each of them reads.
template <class Estimator, class Settings>
OutputPort<WrenchEstimate> add(const StageSite& site, const AcceleratedPorts& given,
                               const Settings& settings) {
  auto& estimator = site.builder.add<Estimator>(site.name, site.robot, settings);
  site.builder.connect(given.platform, estimator.platform);
  site.builder.connect(given.kinematics, estimator.kinematics);
  site.builder.connect(given.dynamics, estimator.dynamics);
  site.builder.connect(given.drive_torque, estimator.torque);
  return estimator.wrench;
}

OutputPort<WrenchEstimate> add_momentum_observer(const StageSite& site, const AcceleratedPorts& given) {
  return add<MomentumObserver>(site, given, site.settings.momentum_observer);
}

OutputPort<WrenchEstimate> add_momentum_kalman_filter(const StageSite& site, const AcceleratedPorts& given) {
  return add<MomentumKalmanFilter>(site, given, site.settings.momentum_kalman_filter);
}

OutputPort<WrenchEstimate> add_sliding_mode_observer(const StageSite& site, const AcceleratedPorts& given) {
  return add<SlidingModeObserver>(site, given, site.settings.sliding_mode_observer);
}

}  // namespace

std::vector<WrenchEstimator> estimator_stages() {
  return {{"momentum_observer", add_momentum_observer},
          {"momentum_kalman_filter", add_momentum_kalman_filter},
          {"sliding_mode_observer", add_sliding_mode_observer}};
}

}  // namespace flinch
