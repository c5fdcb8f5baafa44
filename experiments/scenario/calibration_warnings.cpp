#include "experiments/scenario/calibration_warnings.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "experiments/scenario/estimate_settings.h"
#include "experiments/scenario/scenario.h"
#include "systems/config/config_reader.h"
#include "systems/foundation/nearest_name.h"

namespace flinch {
namespace {

constexpr const char* control_period_key = "control_period";
constexpr double telling_change = 0.01;  // of a torque constant: more than its calibration is off

void append(std::vector<CalibrationWarning>& all, const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) all.push_back({sentence});
}

/// How the calibrations of a scenario are called wherever it is read, from its files or from a recording: by
/// the names of the files, with a number where several have the same.
class Names {
 public:
  explicit Names(const std::vector<ParameterFile>& files) : files_(files) {}

  std::string of(std::size_t file) const {
    const std::string name = base(files_[file]);
    const auto count = std::count_if(files_.begin(), files_.end(),
                                     [&](const ParameterFile& other) { return base(other) == name; });
    return count == 1 ? name : name + " (calibration " + std::to_string(file + 1) + ")";
  }

 private:
  static std::string base(const ParameterFile& file) {
    return std::filesystem::path(file.file).filename().string();
  }

  const std::vector<ParameterFile>& files_;
};

/// Keys of thresholds that a file has, those of an estimator with its name.
std::vector<std::string> thresholds_of(const ParameterFile& file) {
  if (file.nodes == nullptr) return {};
  ConfigReader control = ConfigReader::over(file.nodes, file.file).section("control");
  std::vector<std::string> keys;
  for (const char* const name : {"contact_detector", "fused_detector"}) {
    for (const std::string_view key : control.section(name).keys()) {
      if (key != "by_estimator") keys.push_back(std::string(name) + "." + std::string(key));
    }
  }
  for (ConfigReader& own : control.section("contact_detector").sections("by_estimator")) {
    std::string estimator;
    own.text("estimator", estimator);
    for (const std::string_view key : own.keys()) {
      if (key != "estimator") keys.push_back(std::string(key) + " of " + estimator);
    }
  }
  return keys;
}

/// Where a file replaces what one before it gives.
std::vector<std::string> replaced(const std::vector<ParameterFile>& files) {
  constexpr std::size_t most = 3;  // that are told one by one
  const Names names(files);
  std::vector<std::string> sentences;
  std::map<std::string, std::size_t> given_last_by;
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::vector<std::string> given = thresholds_of(files[i]);
    for (const FileParameter& parameter : files[i].parameters) {
      if (!parameter.belongs_to.empty() && parameter.identifiable) given.push_back(parameter.name);
    }
    std::map<std::size_t, std::vector<std::string>> replaced_of;
    for (const std::string& what : given) {
      const auto [before, is_new] = given_last_by.emplace(what, i);
      if (!is_new && before->second != i) replaced_of[before->second].push_back(what);
      before->second = i;
    }
    for (const auto& [before, what] : replaced_of) {
      const std::size_t told = std::min(what.size(), most);
      const std::string more =
          what.size() > told ? " and " + std::to_string(what.size() - told) + " more" : "";
      sentences.push_back(names.of(i) + ": replaces what " + names.of(before) + " says of " +
                          listed({what.data(), told}) + more);
    }
  }
  return sentences;
}

std::string rests_on(const ParameterFile& file, const std::string& name, const std::string& what,
                     const std::string& noted, const std::string& used) {
  return name + ": rests on " + what + " = " + noted + ", and " + used + " is used; calibrate '" + file.kind +
         "' again";
}

/// Of torque constants that are no longer used.
std::vector<std::string> assumed_otherwise(const ParameterFile& file, const std::string& name,
                                           const Scenario& scenario) {
  std::vector<std::string> sentences;
  const JointVector& constant = scenario.control.drive_torque.torque_constant;
  for (const FileParameter& assumed : file.assumed) {
    for (int i = 0; i < static_cast<int>(constant.size()); ++i) {
      const bool differs = std::abs(constant[i] / assumed.value - 1.0) > telling_change;
      if (assumed.name != drive_constant_key(*scenario.robot.robot, i) || !differs) continue;
      sentences.push_back(
          rests_on(file, name, assumed.name, std::to_string(assumed.value), std::to_string(constant[i])));
    }
  }
  return sentences;
}

/// On settings of estimators that run, and are others now.
std::vector<std::string> set_otherwise(const ParameterFile& file, const std::string& name,
                                       const std::vector<ReadValue>& settings) {
  std::vector<std::string> sentences;
  for (const ReadValue& noted : file.settings) {
    const auto used = std::find_if(settings.begin(), settings.end(),
                                   [&](const ReadValue& setting) { return setting.key == noted.key; });
    if (used == settings.end() || used->value == noted.value || noted.key == control_period_key) continue;
    const std::string unit = noted.unit.empty() ? "" : " " + noted.unit;
    sentences.push_back(rests_on(file, name, noted.key, noted.value + unit, used->value + unit));
  }
  return sentences;
}

/// The noise of estimates goes with the rate, so thresholds are those of one; without a note, of the usual.
std::vector<std::string> at_another_rate(const ParameterFile& file, const std::string& name,
                                         const Scenario& scenario) {
  if (thresholds_of(file).empty()) return {};
  const auto period_in = [](const std::vector<ReadValue>& values) {
    const auto found = std::find_if(values.begin(), values.end(),
                                    [](const ReadValue& value) { return value.key == control_period_key; });
    return found == values.end() ? std::string("0.001") : found->value;
  };
  const std::string noted = period_in(file.settings), used = period_in(scenario.values);
  if (noted == used) return {};
  return {rests_on(file, name, control_period_key, noted + " s", used + " s")};
}

/// Whether the scenario itself says `key`, a path without its unit.
bool says(const Scenario& scenario, const std::string& key) {
  return std::any_of(scenario.values.begin(), scenario.values.end(),
                     [&](const ReadValue& value) { return value.from_file && value.key == key; });
}

/// Whether the scenario has an entry for the estimator that says its `quantity`.
bool says_of(const Scenario& scenario, const std::string& estimator, const std::string& quantity) {
  return std::any_of(scenario.values.begin(), scenario.values.end(), [&](const ReadValue& value) {
    const bool is_entry = value.key.starts_with("control.contact_detector.by_estimator[") &&
                          value.key.ends_with("].estimator") && value.value == estimator;
    return is_entry && says(scenario, value.key.substr(0, value.key.rfind('.') + 1) + quantity);
  });
}

/// A threshold that the scenario gives for all estimators, where that of each is calibrated.
void add_without_effect(std::vector<CalibrationWarning>& warnings, const Scenario& scenario,
                        const std::string& quantity, std::optional<ComponentBounds> OwnThreshold::*value) {
  const std::string key = "control.contact_detector." + quantity;
  if (!says(scenario, key)) return;
  std::vector<std::string> others;
  for (const std::string& estimator : names_of(scenario.control.stages.estimators)) {
    const auto own = scenario.control.reaction_thresholds.find(estimator);
    const bool is_calibrated = own != scenario.control.reaction_thresholds.end() && own->second.*value;
    if (is_calibrated && !says_of(scenario, estimator, quantity)) others.push_back(estimator);
  }
  if (others.empty()) return;
  warnings.push_back({"the scenario's " + key + " does not count for " + listed(others) +
                          ", calibrated by themselves; say it in 'by_estimator' where it shall",
                      key});
}

}  // namespace

std::vector<CalibrationWarning> warnings_about_calibrations(const Scenario& scenario) {
  const std::vector<ParameterFile>& files = scenario.calibrations;
  if (files.empty()) return {};
  const Names names(files);
  const std::string robot_hash = calibrated_robot_hash(scenario.robot_text);
  const std::vector<ReadValue> settings = estimate_settings(scenario);
  std::vector<CalibrationWarning> warnings;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!files[i].robot.sha256.empty() && files[i].robot.sha256 != robot_hash) {
      warnings.push_back({names.of(i) + ": the robot file has changed since this calibration of " +
                          files[i].date +
                          "; calibrate again, or check that what changed does not matter to it"});
    }
    append(warnings, assumed_otherwise(files[i], names.of(i), scenario));
    append(warnings, set_otherwise(files[i], names.of(i), settings));
    append(warnings, at_another_rate(files[i], names.of(i), scenario));
  }
  append(warnings, replaced(files));
  add_without_effect(warnings, scenario, "reaction_force", &OwnThreshold::force);
  add_without_effect(warnings, scenario, "reaction_moment", &OwnThreshold::moment);
  return warnings;
}

}  // namespace flinch
