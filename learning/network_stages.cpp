#include "learning/network_stages.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "diagrams/contact_control_settings.h"
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

ReadModel model_in(const std::filesystem::path& file) {
  ReadModel read{file.string(), read_onnx(file), {}};
  read.network = std::make_shared<NeuralNetwork>(read.model.network);
  return read;
}

/// The models by what they answer. Throws SetupError where these are not one classifier.
ReadModels models_in(const std::vector<std::filesystem::path>& files) {
  ReadModels models;
  Findings found("--classifier: ");
  for (const auto& file : files) {
    ReadModel read = model_in(file);
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
  return papers_networks_stage({.clamping = models.at(Question::clamping).network,
                                .chain = models.at(Question::chain).network,
                                .body = models.at(Question::body).network,
                                .accept = accept,
                                .least_wrench = least_wrench});
}

/// A network that a control path asks.
struct AskedNetwork {
  Question question;
  std::string key;                ///< of the scenario, that names a file
  std::filesystem::path own;      ///< that file; empty: none
  std::filesystem::path shipped;  ///< what comes with flinch
};

ReadModel model_of(const StageContext& site, const AskedNetwork& asked) {
  const bool is_own = !asked.own.empty();
  const std::string place = is_own ? "control.isolation." + asked.key : asked.shipped.string();
  return out_of(place, [&] {
    ReadModel read = model_in(is_own ? asked.own : asked.shipped);
    const Question answered = question_of(read.model);
    if (answered != asked.question)
      throw SetupError(read.file + " answers the question '" + name_of(answered) + "', and that of '" +
                       name_of(asked.question) + "' is asked for");
    require_features(read.model, site.robot);
    return read;
  });
}

OutputPort<ContactClassification> add_papers_networks(const StageContext& site, const ContactPorts& given,
                                                      const std::filesystem::path& shipped) {
  const PapersNetworkFiles& files = site.settings.isolation.papers_networks;
  const auto network = [&](Question question, const std::filesystem::path& own) {
    const std::string name = name_of(question);
    return model_of(site, {question, "papers_networks." + name, own, shipped / ("papers_" + name + ".onnx")})
        .network;
  };
  return papers_networks_stage({.clamping = network(Question::clamping, files.clamping),
                                .chain = network(Question::chain, files.chain),
                                .body = network(Question::body, files.body),
                                .accept = files.accept})
      .add(site, given);
}

OutputPort<ContactClassification> add_learned_classifier(const StageContext& site, const ContactPorts& given,
                                                         const std::filesystem::path& shipped) {
  const IsolationSettings& settings = site.settings.isolation;
  const ReadModel read = model_of(site, {Question::touched, "learned_classifier.network",
                                         settings.learned_network, shipped / "bodies.onnx"});
  return learned_stage(read, settings.model_classifier).add(site, given);
}

}  // namespace

std::vector<ContactClassifier> network_stages(const std::filesystem::path& shipped) {
  const auto from = [&shipped](auto add) {
    return [add, shipped](const StageContext& site, const ContactPorts& given) {
      return add(site, given, shipped);
    };
  };
  return {{"papers_networks", from(add_papers_networks), true},
          {"learned_classifier", from(add_learned_classifier), true}};
}

std::function<void(Scenario&)> follow_networks(const std::vector<std::filesystem::path>& files) {
  return [models = models_in(files)](Scenario& scenario) {
    require_for_robot(models, scenario);
    const auto touched = models.find(Question::touched);
    ContactClassifier stage =
        touched != models.end() ? learned_stage(touched->second, scenario.control.isolation.model_classifier)
                                : papers_stage(models);
    Stages<ContactClassifier>& classifiers = scenario.control.stages.classifiers;
    std::erase_if(classifiers.all, [&](const ContactClassifier& named) { return named.name == stage.name; });
    classifiers.follow(std::move(stage));
  };
}

}  // namespace flinch
