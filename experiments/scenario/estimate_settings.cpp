#include "experiments/scenario/estimate_settings.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "experiments/scenario/scenario.h"

namespace flinch {
namespace {

/// Sections that accelerations and estimators read besides the one of their own name: of the filter that each
/// makes for itself where it does not run, of the observer to which it falls back, of the motion without lag,
/// and of what the IMU is believed by. tests/experiments/simulated/estimate_settings_test.cpp finds them by
/// running.
const std::map<std::string, std::vector<std::string>> other_sections = {
    {"imu_ekf", {"imu_mount", "imu_stamps", "plausibility"}},
    {"extended_imu_ekf", {"imu_mount", "imu_stamps", "plausibility"}},
    {"unscented_imu_filter", {"imu_mount", "imu_stamps", "plausibility"}},
    {"direct_method", {"momentum_observer"}},
    {"direct_imu_ekf", {"imu_ekf", "imu_mount", "imu_stamps", "plausibility", "momentum_observer"}},
    {"direct_extended_imu_ekf",
     {"extended_imu_ekf", "imu_mount", "imu_stamps", "plausibility", "disturbance_filter",
      "momentum_observer"}},
    {"imu_residual", {"imu_mount", "imu_stamps", "plausibility", "disturbance_filter", "momentum_observer"}}};

/// Of the keys that count: sections, each with a dot, and single keys.
std::set<std::string> beginnings(const ControlStages& stages) {
  std::set<std::string> all{"control.drive_torque.aligned_with_velocity", "control.follow.velocity",
                            "control.follow.acceleration", "control.isolation.observer_gain"};
  for (const auto& names :
       {names_of(stages.velocities), names_of(stages.accelerations), names_of(stages.estimators)}) {
    for (const std::string& name : names) {
      all.insert("control." + name + ".");
      const auto others = other_sections.find(name);
      if (others == other_sections.end()) continue;
      for (const std::string& section : others->second) all.insert("control." + section + ".");
    }
  }
  return all;
}

}  // namespace

std::vector<ReadValue> estimate_settings(const Scenario& scenario) {
  const std::set<std::string> begin = beginnings(scenario.control.stages);
  const bool is_usual_rate = scenario.control_period == default_control_period;
  std::vector<ReadValue> settings;
  for (const ReadValue& value : scenario.values) {
    const bool counts = std::any_of(begin.begin(), begin.end(),
                                    [&](const std::string& of) { return value.key.starts_with(of); });
    const bool is_other_rate = value.key == "control_period" && !is_usual_rate;
    if (counts || is_other_rate) settings.push_back(value);
  }
  return settings;
}

}  // namespace flinch
