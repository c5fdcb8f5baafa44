// flinch run --classifier: a network of flinch train in the control path.
#include "apps/flinch/learning_verbs.h"
#include "diagrams/isolation_stages.h"
#include "experiments/scenario/scenario.h"
#include "learning/model_questions.h"
#include "learning/onnx_file.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

void follow_classifier(const std::filesystem::path& model, Scenario& scenario) {
  const ClassifierModel read = read_onnx(model);
  out_of(model.string(), [&] {
    DataSet of_robot;
    of_robot.robot = scenario.robot.robot;
    of_robot.robot_text = scenario.robot_text;
    of_robot.robot_file = scenario.robot_file.string();
    if (features_for(read, of_robot).question() != Question::touched) {
      throw SetupError("answers a question of the papers; a control path follows one of --question touched");
    }
    return 0;
  });
  LearnedClassifierSettings settings;
  settings.network = std::make_shared<NeuralNetwork>(read.network);
  settings.accept = read.accepted_from;
  settings.least_wrench = read.least_wrench;
  settings.window = scenario.control.isolation.model_classifier.window;
  settings.largest_residual = scenario.control.isolation.model_classifier.largest_residual;
  scenario.control.stages.classifiers.follow(learned_classifier_stage(settings));
}

}  // namespace flinch
