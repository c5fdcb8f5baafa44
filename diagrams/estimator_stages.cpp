#include "diagrams/estimator_stages.h"

#include <algorithm>
#include <string>

#include "diagrams/acceleration_stages.h"
#include "diagrams/contact_control_settings.h"
#include "diagrams/low_latency_motion.h"
#include "diagrams/shared_parts.h"
#include "systems/estimators/direct_method.h"
#include "systems/estimators/estimate_fallback.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// An estimator of the momentum: one of its own inputs is all that each of them reads.
template <class Estimator, class Settings>
OutputPort<WrenchEstimate> add(const StageContext& site, const AcceleratedPorts& given,
                               const Settings& settings) {
  auto& estimator = site.builder.add<Estimator>(site.name, site.robot, settings);
  site.builder.connect(given.platform, estimator.platform);
  site.builder.connect(given.kinematics, estimator.kinematics);
  site.builder.connect(given.dynamics, estimator.dynamics);
  site.builder.connect(given.drive_torque, estimator.torque);
  return estimator.wrench;
}

/// Shared: the stage is that to which others fall back.
OutputPort<WrenchEstimate> add_momentum_observer(const StageContext& site, const AcceleratedPorts& given) {
  std::optional<OutputPort<WrenchEstimate>>& observer = site.shared.momentum_observer;
  if (!observer) {
    const StageContext own{site.builder, "momentum_observer", site.robot, site.settings, site.shared};
    observer = add<MomentumObserver>(own, given, site.settings.momentum_observer);
  }
  return *observer;
}

OutputPort<WrenchEstimate> add_momentum_kalman_filter(const StageContext& site,
                                                      const AcceleratedPorts& given) {
  return add<MomentumKalmanFilter>(site, given, site.settings.momentum_kalman_filter);
}

OutputPort<WrenchEstimate> add_sliding_mode_observer(const StageContext& site,
                                                     const AcceleratedPorts& given) {
  return add<SlidingModeObserver>(site, given, site.settings.sliding_mode_observer);
}

/// An estimate that needs the IMU, and beside it the momentum observer for where that fails.
OutputPort<WrenchEstimate> add_fallback(const StageContext& site, const AcceleratedPorts& given,
                                        OutputPort<WrenchEstimate> preferred) {
  auto& fallback = site.builder.add<EstimateFallback>(site.name);
  site.builder.connect(preferred, fallback.preferred);
  site.builder.connect(add_momentum_observer(site, given), fallback.other);
  return fallback.wrench;
}

/// The direct method at the motion and model of `present`.
OutputPort<WrenchEstimate> add_direct(const StageContext& site, const AcceleratedPorts& given,
                                      const AcceleratedPorts& present,
                                      OutputPort<PlatformAcceleration> acceleration) {
  DiagramBuilder& builder = site.builder;
  auto& direct = builder.add<DirectMethod>(site.name + "_method", site.robot,
                                           Sampling::each(site.settings.control_period));
  builder.connect(present.platform, direct.platform);
  builder.connect(present.kinematics, direct.kinematics);
  builder.connect(present.dynamics, direct.dynamics);
  builder.connect(add_present_torque(site, given), direct.torque);
  builder.connect(acceleration, direct.acceleration);
  return add_fallback(site, given, direct.wrench);
}

OutputPort<WrenchEstimate> add_direct_method(const StageContext& site, const AcceleratedPorts& given) {
  if (given.accelerations.empty()) {
    throw SetupError("the estimator '" + site.name +
                     "' needs an acceleration: let one of control.accelerations run");
  }
  return add_direct(site, given, given, given.acceleration);
}

/// The acceleration of the source of this name: that which runs, else one for this estimator alone.
OutputPort<PlatformAcceleration> acceleration_of(const std::string& name, const StageContext& site,
                                                 const AcceleratedPorts& given) {
  for (const auto& running : given.accelerations) {
    if (running.name == name) return running.port;
  }
  const std::vector<AccelerationSource> known = acceleration_stages();
  const auto source = std::find_if(known.begin(), known.end(),
                                   [&](const AccelerationSource& each) { return each.name == name; });
  return source->add(part(site, name), given);
}

OutputPort<WrenchEstimate> add_direct_imu_ekf(const StageContext& site, const AcceleratedPorts& given) {
  return add_direct(site, given, given, acceleration_of("imu_ekf", site, given));
}

OutputPort<WrenchEstimate> add_direct_extended_imu_ekf(const StageContext& site,
                                                       const AcceleratedPorts& given) {
  return add_direct(site, given, low_latency(site, given), acceleration_of("extended_imu_ekf", site, given));
}

OutputPort<WrenchEstimate> add_disturbance_filter(const StageContext& site, const AcceleratedPorts& given) {
  return add_encoder_filter(site, given, site.settings.disturbance_filter).wrench;
}

OutputPort<WrenchEstimate> add_imu_residual_alone(const StageContext& site, const AcceleratedPorts& given) {
  return add_imu_residual(site, given, low_latency(site, given));
}

}  // namespace

std::vector<WrenchEstimator> estimator_stages() {
  return {{"momentum_observer", add_momentum_observer},
          {"momentum_kalman_filter", add_momentum_kalman_filter},
          {"sliding_mode_observer", add_sliding_mode_observer},
          {"direct_method", add_direct_method},
          {"direct_imu_ekf", add_direct_imu_ekf},
          {"direct_extended_imu_ekf", add_direct_extended_imu_ekf},
          {"disturbance_filter", add_disturbance_filter},
          {"imu_residual", add_imu_residual_alone}};
}

OutputPort<WrenchEstimate> add_imu_residual(const StageContext& site, const AcceleratedPorts& given,
                                            const AcceleratedPorts& present) {
  DiagramBuilder& builder = site.builder;
  ImuResidualSettings settings = site.settings.imu_residual;
  settings.mount = site.settings.imu_mount;
  settings.stamp_spread = site.settings.imu_stamp_spread;
  auto& residual = builder.add<ImuResidual>(site.name + "_method", site.robot, settings);
  builder.connect(present.platform, residual.platform);
  builder.connect(present.kinematics, residual.kinematics);
  builder.connect(present.dynamics, residual.dynamics);
  builder.connect(add_present_torque(site, given), residual.torque);
  builder.connect(given.imu, residual.imu);
  return add_fallback(site, given, residual.wrench);
}

}  // namespace flinch
