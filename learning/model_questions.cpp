#include "learning/model_questions.h"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>

#include "systems/contact/evidence_features.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

std::string value_of(const ClassifierModel& model, const std::string& key) {
  const auto found = model.provenance.find(key);
  return found == model.provenance.end() ? "" : found->second;
}

/// Says at which place two lists of names part; the first that differs tells the most.
void compare(const std::vector<std::string>& of_model, const std::vector<std::string>& wanted,
             const char* what, Findings& found) {
  for (std::size_t i = 0; i < std::max(of_model.size(), wanted.size()); ++i) {
    const std::string mine = i < of_model.size() ? "'" + of_model[i] + "'" : "missing";
    const std::string right = i < wanted.size() ? "'" + wanted[i] + "'" : "none";
    if (mine == right) continue;
    found.add(fmt::format("{} {} of the model is {} and must be {}; a network is told numbers by their place",
                          what, i + 1, mine, right));
    return;
  }
}

void require_names(const ClassifierModel& model, const FeatureSet& features, const std::string& prefix = "") {
  Findings found(prefix);
  compare(model.features, features.names(), "feature", found);
  compare(model.classes, features.classes(), "class", found);
  throw_if_any(found.take());
}

std::string card_of(const DataSet& data, const std::string& key) {
  const auto found = data.card.find(key);
  return found == data.card.end() ? "" : found->second;
}

/// Configurations as they stand in the metadata, "0, 2"; none means all, on either side.
bool share_one(const std::string& learned, const std::vector<int>& asked) {
  if (learned.empty() || asked.empty()) return true;
  std::istringstream numbers(learned);
  for (std::string number; std::getline(numbers >> std::ws, number, ',');) {
    if (std::any_of(asked.begin(), asked.end(), [&](int each) { return std::to_string(each) == number; }))
      return true;
  }
  return false;
}

}  // namespace

void check_features(const ClassifierModel& model) {
  if (value_of(model, "question") != name_of(Question::touched)) return;
  std::vector<std::string> names;
  for (const FeatureName& each : evidence_feature_names()) names.push_back(each.name);
  Findings found;
  compare(model.features, names, "feature", found);
  throw_if_any(found.take());
}

Question question_of(const ClassifierModel& model) {
  const std::string question = value_of(model, "question");
  if (question.empty()) {
    throw SetupError(
        "the metadata of the model do not say which question it answers; 'flinch.question' must be touched, "
        "body, clamping or chain");
  }
  return question_named(question);
}

FeatureSet features_for(const ClassifierModel& model, const DataSet& data) {
  const Question asked = question_of(model);
  const std::string fitted = value_of(model, "robot.fingerprint");
  if (!fitted.empty() && fitted != fingerprint(data.robot_text, data.robot_file)) {
    throw SetupError(fmt::format(
        "the model was trained for the robot '{}', the data are of '{}', or of one with other parameters; "
        "train it anew with data of this robot",
        value_of(model, "robot.name"), data.robot->name()));
  }
  FeatureSet features(asked, data.robot);
  const std::string told = value_of(model, "features.check");
  if (!fitted.empty() && !told.empty() && told != features.check()) {
    throw SetupError(
        "the features that the model was trained with were made otherwise, by another version of flinch; "
        "train it anew");
  }
  require_names(model, features);
  return features;
}

void require_features(const ClassifierModel& model, const std::shared_ptr<const ParallelRobot>& robot) {
  const FeatureSet features(question_of(model), robot);
  require_names(model, features,
                "it was trained for the robot '" + value_of(model, "robot.name") + "', and this one is '" +
                    robot->name() + "': ");
  const std::string told = value_of(model, "features.check");
  if (told.empty() || told == features.check()) return;
  throw SetupError(fmt::format(
      "the model was trained for the robot '{}', and '{}' has another geometry, or its features were made "
      "otherwise, by another version of flinch; train it anew with data of this robot",
      value_of(model, "robot.name"), robot->name()));
}

std::string warning_of_learned(const ClassifierModel& model, const DataSet& data,
                               const std::vector<int>& configurations) {
  const auto is_of_model = [&model](const std::string& key, const std::string& value) {
    return !value.empty() && value_of(model, key) == value;
  };
  const bool is_same_draw =
      is_of_model("data.title", card_of(data, "title")) && is_of_model("data.seed", card_of(data, "seed"));
  const bool is_same_file = is_of_model("data.sha256", data.sha256);
  if (!is_same_file && !is_same_draw) return "";
  if (!share_one(value_of(model, "data.configurations"), configurations)) return "";
  return std::string("the model has learned from ") +
         (is_same_file ? "these data" : "data of the same title and seed") +
         "; the figures tell what it remembers, not how well it does with contacts that are new to it";
}

}  // namespace flinch
