// flinch run and flinch campaign --classifier: networks of flinch train in the control path.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/flinch/learning_verbs.h"
#include "diagrams/isolation_stages.h"
#include "experiments/scenario/scenario.h"
#include "learning/model_questions.h"
#include "learning/onnx_file.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

struct ReadModel {
  std::string file;
  ClassifierModel model;
  std::shared_ptr<const NeuralNetwork> network;
};
using ReadModels = std::map<Question, ReadModel>;

/// The models by what they answer. Throws SetupError where these are not one classifier.
ReadModels models_in(const std::vector<std::filesystem::path>& files) {
  ReadModels models;
  Findings found("--classifier: ");
  for (const auto& file : files) {
    ReadModel read{file.string(), read_onnx(file), {}};
    read.network = std::make_shared<NeuralNetwork>(read.model.network);
    const Question question = out_of(read.file, [&] { return question_of(read.model); });
    const auto [place, is_first] = models.try_emplace(question, read);
    found.require(is_first, place->second.file + " and " + read.file + " both answer the question '" +
                                name_of(question) + "'; a control path follows one of them");
  }
  const bool has_touched = models.contains(Question::touched);
  found.require(!has_touched || models.size() == 1,
                "a model of the question 'touched' needs no other beside it; leave it out, or the others");
  for (const Question question : {Question::clamping, Question::chain, Question::body}) {
    found.require(has_touched || models.contains(question),
                  "the question '" + name_of(question) +
                      "' has no model; of the papers' questions clamping, chain and body a control path asks "
                      "all three: add --classifier MODEL.onnx for it, or follow one of the question touched");
  }
  throw_if_any(found.take());
  return models;
}

void require_for_robot(const ReadModels& models, const Scenario& scenario) {
  DataSet of_robot;
  of_robot.robot = scenario.robot.robot;
  of_robot.robot_text = scenario.robot_text;
  of_robot.robot_file = scenario.robot_file.string();
  std::vector<std::string> problems;
  for (const auto& [question, read] : models) {
    try {
      out_of(read.file, [&, &model = read.model] { return features_for(model, of_robot); });
    } catch (const SetupError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  throw_if_any(std::move(problems));
}

ContactClassifier learned_stage(const ReadModel& read, const ModelClassifierSettings& of_scenario) {
  return learned_classifier_stage({.network = read.network,
                                   .accept = read.model.accepted_from,
                                   .least_wrench = read.model.least_wrench,
                                   .window = of_scenario.window,
                                   .largest_residual = of_scenario.largest_residual});
}

/// What is accepted then is accepted by each network alone, for a product is at most as large as its factors,
/// and asked about only what all of them have learned of.
ContactClassifier papers_stage(const ReadModels& models) {
  double accept = 0.0, least_wrench = 0.0;
  for (const auto& [question, read] : models) {
    accept = std::max(accept, read.model.accepted_from);
    least_wrench = std::max(least_wrench, read.model.least_wrench);
  }
  return papers_classifier_stage({.clamping = models.at(Question::clamping).network,
                                  .chain = models.at(Question::chain).network,
                                  .body = models.at(Question::body).network,
                                  .accept = accept,
                                  .least_wrench = least_wrench});
}

}  // namespace

std::function<void(Scenario&)> classifier_of(const std::vector<std::filesystem::path>& files) {
  return [models = models_in(files)](Scenario& scenario) {
    require_for_robot(models, scenario);
    const auto touched = models.find(Question::touched);
    scenario.control.stages.classifiers.follow(
        touched != models.end() ? learned_stage(touched->second, scenario.control.isolation.model_classifier)
                                : papers_stage(models));
  };
}

}  // namespace flinch
