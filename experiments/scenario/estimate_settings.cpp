#include "experiments/scenario/estimate_settings.h"

#include <algorithm>
#include <string>

#include "experiments/scenario/scenario.h"

namespace flinch {
namespace {

/// "control.", the names of stages that run, each with a dot, and single keys.
std::vector<std::string> beginnings(const ControlStages& stages) {
  std::vector<std::string> all{"control.drive_torque.aligned_with_velocity", "control.follow.velocity"};
  for (const auto& names :
       {names_of(stages.velocities), names_of(stages.accelerations), names_of(stages.estimators)}) {
    for (const std::string& name : names) all.push_back("control." + name + ".");
  }
  return all;
}

}  // namespace

std::vector<ReadValue> estimate_settings(const Scenario& scenario) {
  const std::vector<std::string> begin = beginnings(scenario.control.stages);
  std::vector<ReadValue> settings;
  for (const ReadValue& value : scenario.values) {
    const bool counts = std::any_of(begin.begin(), begin.end(),
                                    [&](const std::string& of) { return value.key.starts_with(of); });
    if (counts) settings.push_back(value);
  }
  return settings;
}

}  // namespace flinch
