// flinch run and flinch campaign --classifier: a network of flinch train in the control path.
#include "apps/flinch/learning_verbs.h"
#include "diagrams/isolation_stages.h"
#include "experiments/scenario/scenario.h"
#include "learning/model_questions.h"
#include "learning/onnx_file.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

void require_touched(const ClassifierModel& model, const Scenario& scenario) {
  DataSet of_robot;
  of_robot.robot = scenario.robot.robot;
  of_robot.robot_text = scenario.robot_text;
  of_robot.robot_file = scenario.robot_file.string();
  if (features_for(model, of_robot).question() != Question::touched) {
    throw SetupError("answers a question of the papers; a control path follows one of --question touched");
  }
}

}  // namespace

std::function<void(Scenario&)> classifier_of(const std::filesystem::path& model) {
  const auto read = std::make_shared<const ClassifierModel>(read_onnx(model));
  LearnedClassifierSettings settings;
  settings.network = std::make_shared<NeuralNetwork>(read->network);
  settings.accept = read->accepted_from;
  settings.least_wrench = read->least_wrench;
  return [model, read, settings](Scenario& scenario) {
    out_of(model.string(), [&] { require_touched(*read, scenario); });
    LearnedClassifierSettings of_scenario = settings;
    of_scenario.window = scenario.control.isolation.model_classifier.window;
    of_scenario.largest_residual = scenario.control.isolation.model_classifier.largest_residual;
    scenario.control.stages.classifiers.follow(learned_classifier_stage(of_scenario));
  };
}

}  // namespace flinch
