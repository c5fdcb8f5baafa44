#include "diagrams/fused_detector.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "diagrams/contact_control_settings.h"
#include "diagrams/estimator_stages.h"
#include "diagrams/low_latency_motion.h"
#include "systems/contact/max_detector.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/constant.h"
#include "systems/model/drive_loads.h"
#include "systems/signals/stamp_spread.h"

namespace flinch {
namespace {

OutputPort<DriveLoad> add_loads(const StageContext& site, const AcceleratedPorts& given,
                                const LowLatencyPorts& present) {
  auto& loads = site.builder.add<DriveLoads>(site.name + "_loads", site.robot);
  site.builder.connect(present.platform, loads.platform);
  site.builder.connect(present.kinematics, loads.kinematics);
  site.builder.connect(present.dynamics, loads.dynamics);
  site.builder.connect(add_present_torque(site, given), loads.torque);
  return loads.load;
}

/// That which runs, else one for this detector alone; of those that need a motion without a lag it is the
/// detector's.
OutputPort<WrenchEstimate> estimate_of(const std::string& name, const StageContext& site,
                                       const EstimatePorts& given, const LowLatencyPorts& present) {
  std::vector<std::string> known;
  for (const auto& running : given.estimates) {
    if (running.name == name) return running.port;
    known.push_back(running.name);
  }
  if (name == "disturbance_filter") return present.disturbance;
  if (name == "imu_residual") return add_imu_residual(part(site, name), given, present);
  for (const WrenchEstimator& stage : estimator_stages()) {
    if (stage.name == name) return stage.add(part(site, name), given);
    known.push_back(stage.name);
  }
  throw SetupError(site.name + ": there is no estimator '" + name + "'" + did_you_mean(name, known));
}

/// With what stamps that err make of the residual of the IMU, where more is stated than was calibrated: of
/// two in a row, behind an observer of the gyroscope; and of how late torques are.
MahalanobisThreshold with_stamps(MahalanobisThreshold limit, const ContactControlSettings& settings) {
  const double deviation = uniform_deviation(settings.imu_stamp_spread);
  const double T = to_seconds(settings.control_period);
  const double a = std::exp(-settings.imu_residual.gyroscope_gain * T);
  limit.errors.turning =
      std::max(limit.errors.turning, deviation * (1.0 - a) * std::sqrt(2.0 / (1.0 + a)) / T);
  limit.errors.lag = std::max(limit.errors.lag, deviation);
  return limit;
}

OutputPort<ContactDetection> add_residual(const StageContext& site, const FusedResidual& residual,
                                          const EstimatePorts& given, const LowLatencyPorts& present,
                                          OutputPort<DriveLoad> load) {
  WhitenedDetectorSettings settings{.level = residual.level,
                                    .change = residual.change,
                                    .smoothed = residual.smoothed,
                                    .tracking = tracking_of(residual.estimator, site.settings),
                                    .hard = site.settings.contact_detector.hard};
  if (residual.estimator == "imu_residual") {
    settings.level = with_stamps(settings.level, site.settings);
    settings.change = with_stamps(settings.change, site.settings);
    if (settings.smoothed) settings.smoothed = with_stamps(*settings.smoothed, site.settings);
  }
  const std::string name = site.name + "_by_" + residual.estimator;
  if (site.settings.fused_detector.rule == ChangeRule::likelihood_ratio) {
    if (!residual.onset)
      throw SetupError(
          name + ": has no onset, by which likelihood_ratio judges; flinch calibrate thresholds finds it");
    settings.onset = residual.onset;
  }
  auto& detector = site.builder.add<WhitenedDetector>(name, site.robot, settings);
  site.builder.connect(estimate_of(residual.estimator, site, given, present), detector.wrench);
  site.builder.connect(load, detector.load);
  site.builder.connect(given.reset, detector.reset);
  return detector.contact;
}

OutputPort<ContactDetection> add_nothing(const StageContext& site) {
  if (followed_name(site.settings.stages.detectors) == site.name) {
    throw SetupError(site.name +
                     " is followed but has no residuals to judge by; flinch calibrate thresholds finds them");
  }
  return site.builder.add<Constant<ContactDetection>>(site.name, ContactDetection()).value;
}

}  // namespace

ResidualTracking tracking_of(const std::string& estimator, const ContactControlSettings& settings) {
  ResidualTracking tracking = settings.fused_detector.tracking;
  if (estimator == "disturbance_filter")
    tracking.answer = {.filters = 3, .rate = settings.disturbance_filter.pole};
  return tracking;
}

OutputPort<ContactDetection> add_fused_detector(const StageContext& site, const EstimatePorts& given) {
  const LowLatencyPorts present = low_latency(site, given);
  const OutputPort<DriveLoad> load = add_loads(site, given, present);
  if (site.loads != nullptr) site.loads->push_back({site.name, load});
  const std::vector<FusedResidual>& residuals = site.settings.fused_detector.residuals;
  if (residuals.empty()) return add_nothing(site);
  OutputPort<ContactDetection> detected = add_residual(site, residuals.front(), given, present, load);
  for (std::size_t i = 1; i < residuals.size(); ++i) {
    const std::string name = i + 1 < residuals.size() ? site.name + "_" + std::to_string(i) : site.name;
    auto& either = site.builder.add<MaxDetector>(name);
    site.builder.connect(detected, either.first);
    site.builder.connect(add_residual(site, residuals[i], given, present, load), either.second);
    detected = either.contact;
  }
  return detected;
}

}  // namespace flinch
