// What the errors of an estimate rest on, found by running: every key of the control path is changed, one at
// a time, on the same readings, and what then comes out otherwise must be among the settings that count.
#include "experiments/scenario/estimate_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <sstream>

#include "diagrams/estimator_stages.h"
#include "experiments/recorded/replay.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

/// Calibrated for each robot, and doubted for itself, with what is no more than its rounding left out.
const std::string torque_constant = "control.drive_torque.torque_constant";

const char* const sources = "accelerations: [imu_ekf, extended_imu_ekf], follow: {acceleration: ";

std::vector<std::string> names() {
  std::vector<std::string> names;
  for (const WrenchEstimator& stage : estimator_stages()) names.push_back(stage.name);
  return names;
}

SimulatedScenario scenario(const std::string& control) {
  const test::Workplace place;
  place.write("scenarios/own.yaml",
              "robot: ../robots/planar_3rrr.yaml\nduration_s: 0.55\nseed: 3\n"
              "motion: {kind: square, start_ms: 300, side_mm: 40, limits: {acceleration_m_per_s2: 12, "
              "jerk_m_per_s3: 2000}}\nplant: {realism: bench}\ncontrol: " +
                  control + "\n");
  return read_simulated_scenario(place / "scenarios/own.yaml");
}

/// How a key of this unit ends: "_m_per_s2".
std::string ending(const std::string& symbol) {
  if (symbol.empty()) return "";
  std::string key = symbol.starts_with("1/") ? "per_" + symbol.substr(2) : symbol;
  for (std::size_t at = key.find('/'); at != std::string::npos; at = key.find('/'))
    key.replace(at, 1, "_per_");
  std::erase(key, '^');
  std::erase(key, ' ');
  return "_" + key;
}

/// {a: {b_m: value}} of the key control.a.b.
std::string tree(const ReadValue& setting, const std::string& value) {
  std::string open, close;
  std::istringstream path(setting.key.substr(std::string("control.").size()));
  std::string step;
  std::getline(path, step, '.');
  std::string text = step;
  while (std::getline(path, step, '.')) {
    text += ": {" + step;
    close += "}";
  }
  return text + ending(setting.unit) + ": " + value + close;
}

/// The number by that share more; something where it is 0.
double changed(double number, double share) { return number == 0.0 ? share / 4.0 : (1.0 + share) * number; }

/// Another value of the same kind; "" where there is none that a test could guess.
std::string changed(const std::string& value, double share) {
  if (value == "true") return "false";
  if (value == "false") return "true";
  if (value == "tustin") return "backward_difference";
  if (value == "imu_ekf") return "extended_imu_ekf";
  std::string text = value;
  const bool is_list = text.starts_with('[');
  std::erase_if(text, [](char letter) { return letter == '[' || letter == ']' || letter == ','; });
  std::istringstream numbers(text);
  std::ostringstream out;
  out.precision(17);
  double number = 0.0;
  int count = 0;
  while (numbers >> number) out << (count++ > 0 ? ", " : "") << changed(number, share);
  if (count == 0 || !numbers.eof()) return "";
  return is_list ? "[" + out.str() + "]" : out.str();
}

using Estimates = std::map<std::string, std::vector<WrenchEstimate>>;

class WhatEstimatesRestOn : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    all_ = new std::string(std::string("estimators: [") + listed_names() + "], " + sources + "imu_ekf}");
    base_ = new SimulatedScenario(scenario("{" + *all_ + "}"));
    readings_ = new Recording(run_experiment(*base_));
    before_ = new Estimates(estimates(*base_));
  }
  static void TearDownTestSuite() {
    delete all_;
    delete base_;
    delete readings_;
    delete before_;
  }

  static std::string listed_names() {
    std::string list;
    for (const std::string& name : names()) list += (list.empty() ? "" : ", ") + name;
    return list;
  }

  static Estimates estimates(const Scenario& scenario) {
    const Recording made = replay(scenario, *readings_).recording;
    Estimates estimates;
    for (const std::string& name : names()) {
      const std::string path = name == names().front() ? std::string("wrench") : "wrench_" + name;
      const auto values = read<WrenchEstimate>(made, path);
      for (std::size_t k = 0; k < values.size(); ++k) estimates[name].push_back(values[k]);
    }
    return estimates;
  }

  /// The scenario with that key changed; a set-up error where no change of it is taken.
  static SimulatedScenario with(const ReadValue& setting, const std::string& value) {
    std::string control = *all_;
    if (setting.key == "control.follow.acceleration") {
      control.replace(control.find("imu_ekf}"), 7, value);
      return scenario("{" + control + "}");
    }
    return scenario("{" + control + ", " + tree(setting, value) + "}");
  }

  static std::optional<SimulatedScenario> changed_scenario(const ReadValue& setting) {
    for (const double share : {0.25, -0.25}) {
      const std::string value = changed(setting.value, share);
      if (value.empty()) return std::nullopt;
      try {
        return with(setting, value);
      } catch (const SetupError&) {
        if (share < 0.0) return std::nullopt;
      }
    }
    return std::nullopt;
  }

  /// Estimators of which anything comes out otherwise.
  static std::set<std::string> differing(const Estimates& now) {
    std::set<std::string> all;
    for (const auto& [name, estimates] : now) {
      const std::vector<WrenchEstimate>& before = before_->at(name);
      const bool same = std::equal(estimates.begin(), estimates.end(), before.begin(), before.end(),
                                   [](const WrenchEstimate& a, const WrenchEstimate& b) {
                                     return a.valid == b.valid && a.wrench_in_base == b.wrench_in_base;
                                   });
      if (!same) all.insert(name);
    }
    return all;
  }

  static std::set<std::string> counted(const std::string& estimator) {
    std::set<std::string> keys;
    for (const ReadValue& setting :
         estimate_settings(scenario("{estimators: [" + estimator + "], " + sources + "imu_ekf}}")))
      keys.insert(setting.key);
    return keys;
  }

  static std::string* all_;
  static SimulatedScenario* base_;
  static Recording* readings_;
  static Estimates* before_;
};
std::string* WhatEstimatesRestOn::all_ = nullptr;
SimulatedScenario* WhatEstimatesRestOn::base_ = nullptr;
Recording* WhatEstimatesRestOn::readings_ = nullptr;
Estimates* WhatEstimatesRestOn::before_ = nullptr;

TEST_F(WhatEstimatesRestOn, IsAllAmongTheSettingsThatCount) {
  std::map<std::string, std::set<std::string>> counted_of;
  for (const std::string& name : names()) counted_of[name] = counted(name);
  std::set<std::string> acting;
  int tried = 0;
  for (const ReadValue& setting : base_->values) {
    if (!setting.key.starts_with("control.") || setting.key == torque_constant) continue;
    const std::optional<SimulatedScenario> changed = changed_scenario(setting);
    if (!changed) continue;
    ++tried;
    for (const std::string& estimator : differing(estimates(*changed))) {
      acting.insert(setting.key);
      EXPECT_TRUE(counted_of[estimator].contains(setting.key))
          << estimator << " rests on " << setting.key << " = " << setting.value;
    }
  }
  EXPECT_GT(tried, 100) << "keys could be changed";
  for (const char* const key :
       {"velocity_filter.cutoff_frequency", "velocity_filter.form", "imu_mount.position", "imu_mount.angles",
        "disturbance_filter.pole", "follow.acceleration", "momentum_observer.gain",
        "drive_torque.aligned_with_velocity"})
    EXPECT_TRUE(acting.contains(std::string("control.") + key)) << key;
}

}  // namespace
}  // namespace flinch
