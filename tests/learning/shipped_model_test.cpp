#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "learning/evaluation.h"
#include "learning/model_questions.h"
#include "learning/onnx_file.h"
#include "systems/config/robot_file.h"
#include "tests/learning/contact_examples.h"
#include "tests/support/file_bytes.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

ClassifierModel shipped() { return read_onnx(FLINCH_SOURCE_DIR "/apps/models/bodies.onnx"); }

TEST(ShippedModel, FitsTheShippedRobotAndThisVersionOfItsFeatures) {
  const ClassifierModel model = shipped();
  EXPECT_EQ(features_for(model, test::contact_examples(1, 1)).question(), Question::touched);
  EXPECT_GT(std::stod(model.provenance.at("cross_validated_accuracy")), 0.92);
  EXPECT_GT(model.least_wrench, 4.0)
      << "contacts that are detected earlier than those that it has learned of";
}

TEST(ShippedModel, IsRefusedWithoutARobotWhereItsFeaturesAreThoseOfAnotherVersion) {
  ClassifierModel model = shipped();
  EXPECT_NO_THROW(check_features(model));
  model.features.pop_back();
  EXPECT_THAT(test::problems_of([&] { check_features(model); }),
              testing::ElementsAre(testing::HasSubstr(" of the model is missing and must be ")));
  model.provenance["question"] = "body";
  EXPECT_NO_THROW(check_features(model)) << "its features are those of a robot";
}

/// Without samples; it has another number of legs and other bodies.
DataSet of_five_bar() {
  const std::string file = FLINCH_SOURCE_DIR "/apps/robots/five_bar.yaml";
  DataSet data;
  data.robot_file = file;
  data.robot_text = test::bytes_of(file);
  data.robot = parse_robot_file(data.robot_text, file).robot;
  return data;
}

TEST(ShippedModel, IsRefusedOnceForAnotherRobot) {
  EXPECT_THAT(
      test::problems_of([] { features_for(shipped(), of_five_bar()); }),
      testing::ElementsAre("the model was trained for the robot 'planar 3-RRR bench', the data are of "
                           "'five-bar', or of one with other parameters; train it anew with data of "
                           "this robot"));
}

TEST(ShippedModel, IsRefusedOnceWhereItsFeaturesWereMadeOtherwise) {
  ClassifierModel model = shipped();
  model.provenance["features.check"] = "1";
  model.features.pop_back();
  EXPECT_THAT(test::problems_of([&] { features_for(model, test::contact_examples(1, 1)); }),
              testing::ElementsAre(testing::HasSubstr("by another version of flinch")));
}

TEST(ShippedModel, TellsContactsThatNoSimulationMade) {
  const ClassifierModel model = shipped();
  const DataSet data = test::contact_examples(1000, 3);
  const FeatureSet features = features_for(model, data);
  const Questions questions = questions_of(data, features, {}, false, 2);
  const Evaluation evaluation = evaluate(answers_of(NeuralNetwork(model.network), questions, data), features,
                                         model.accepted_from, "all");
  EXPECT_GT(*evaluation.confusion.balanced_accuracy(), 0.93);
  EXPECT_LT(evaluation.accepted.wrong_of_accepted, 0.02);
}

}  // namespace
}  // namespace flinch
