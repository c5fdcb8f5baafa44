#include "learning/train_classifier.h"

#include <gmock/gmock.h>

#include <cmath>

#include "learning/model_questions.h"
#include "learning/onnx_file.h"
#include "tests/learning/contact_examples.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

ClassifierTraining quick(Question question) {
  ClassifierTraining training;
  training.question = question;
  TrainingSettings settings = standard_settings(question);
  settings.epochs = 40;
  training.candidates = {settings};
  training.folds = 3;
  training.threads = 2;
  return training;
}

Evaluation asked(const ClassifierModel& model, const DataSet& data) {
  const FeatureSet features = features_for(model, data);
  const Questions questions = questions_of(data, features, {}, false, 2);
  return evaluate(answers_of(NeuralNetwork(model.network), questions, data), features, model.accepted_from,
                  "all");
}

TEST(TrainClassifier, FindsWhatWasTouchedAsWellAsItSays) {
  const TrainedClassifier trained =
      train_classifier(test::contact_examples(3000, 1), quick(Question::touched));
  const Evaluation evaluation =
      asked(parse_onnx(onnx_bytes(trained.model), "model.onnx"), test::contact_examples(1000, 2));
  EXPECT_GT(*evaluation.confusion.balanced_accuracy(), 0.9);
  EXPECT_NEAR(*evaluation.confusion.balanced_accuracy(), *trained.expected.confusion.balanced_accuracy(),
              0.03);
  EXPECT_LT(evaluation.calibration_error, 0.03);
  EXPECT_LT(evaluation.accepted.wrong_of_accepted, 0.02);
}

TEST(TrainClassifier, AnswersThePapersThreeQuestions) {
  const DataSet data = test::contact_examples(3000, 1), other = test::contact_examples(600, 2);
  const auto asked_about = [&](Question question) {
    return asked(train_classifier(data, quick(question)).model, other);
  };
  EXPECT_GT(*asked_about(Question::body).body, 0.8);
  EXPECT_GT(*asked_about(Question::clamping).collision_clamping, 0.7);
  EXPECT_GT(*asked_about(Question::chain).chain, 0.9);
}

TEST(TrainClassifier, FindsTheSameBitsOnAnyNumberOfThreads) {
  const DataSet data = test::contact_examples(200, 1);
  ClassifierTraining training = quick(Question::body);
  training.candidates.front().epochs = 2;
  training.threads = 1;
  const std::string one = onnx_bytes(train_classifier(data, training).model);
  training.threads = 3;
  EXPECT_EQ(onnx_bytes(train_classifier(data, training).model), one);
}

TEST(TrainClassifier, CombinesEachNumberOfEpochsWithEachL2) {
  const SearchedSettings searched = searched_settings(Question::body);
  const auto all = combinations(standard_settings(Question::body), searched);
  ASSERT_EQ(all.size(), searched.epochs.size() * searched.l2.size());
  EXPECT_EQ(all.front().epochs, searched.epochs.front());
  EXPECT_EQ(all.back().l2, searched.l2.back());
  EXPECT_EQ(all.back().hidden, standard_settings(Question::body).hidden);
  EXPECT_EQ(combinations(TrainingSettings(), searched_settings(Question::touched)).size(), 1U);
}

TEST(TrainClassifier, TakesTheBestOfItsCandidates) {
  const DataSet data = test::contact_examples(400, 1);
  ClassifierTraining training = quick(Question::chain);
  TrainingSettings bad = training.candidates.front();
  bad.learning_rate = 1e-7;
  training.candidates = {bad, training.candidates.front(), bad};
  const TrainedClassifier trained = train_classifier(data, training);
  EXPECT_EQ(trained.settings.learning_rate, training.candidates[1].learning_rate);
  EXPECT_EQ(trained.accuracies.size(), 3U);
  EXPECT_GT(trained.accuracies[1], trained.accuracies[0]);
  EXPECT_LT(trained.losses[1], trained.losses[0]);
  EXPECT_NEAR(trained.losses[0], std::log(3.0), 0.5) << "as good as guessing among three legs";
}

/// Contacts that one wrench in each configuration gives away, and nothing besides.
DataSet contacts_known_by_heart() {
  DataSet data = test::contact_examples(600, 1);
  const ContactClasses classes = classes_of(*data.robot);
  for (std::size_t i = 0; i < data.samples.size(); ++i) {
    DataSample& sample = data.samples[i];
    sample.configuration = static_cast<int>(i % 12);
    sample.touched = (5 * sample.configuration) % classes.bodies();
    sample.pose = data.robot->home_pose();
    const double angle = 2.0 * M_PI * sample.configuration / 12.0;
    for (ContactMoment& moment : sample.course)
      moment.wrench_in_base = Eigen::Vector3d(30.0 * std::cos(angle), 30.0 * std::sin(angle), 0.0);
  }
  return data;
}

TEST(TrainClassifier, AsksAboutConfigurationsThatItHasNotLearnedFromWhereFoldsAreByConfiguration) {
  const DataSet data = contacts_known_by_heart();
  ClassifierTraining training = quick(Question::body);
  training.candidates.front().learning_rate = 1e-2;
  EXPECT_GT(train_classifier(data, training).accuracies.front(), 0.95);
  training.folds_by = FoldsBy::configuration;
  const TrainedClassifier trained = train_classifier(data, training);
  EXPECT_LT(trained.accuracies.front(), 0.3);
  EXPECT_EQ(trained.model.provenance.at("folds_by"), "configuration");
  training.folds = 13;
  EXPECT_THAT(
      test::problems_of([&] { train_classifier(data, training); }),
      testing::ElementsAre("there are 12 configurations to learn from; 13 folds need at least as many"));
}

TEST(TrainClassifier, TellsWhatItWasTrainedWith) {
  DataSet data = test::contact_examples(100, 1);
  data.sha256 = std::string(64, '7');
  ClassifierTraining training = quick(Question::body);
  training.candidates.front().epochs = 1;
  training.candidates.front().batch = 128;
  training.filter.configurations = {0, 2};
  const std::string bytes = onnx_bytes(train_classifier(data, training).model);
  const auto told = parse_onnx(bytes, "model.onnx").provenance;
  EXPECT_EQ(told.at("data.sha256"), data.sha256);
  EXPECT_EQ(told.at("data.configurations"), "0, 2");
  EXPECT_EQ(told.at("learning_rate"), "0.001");
  EXPECT_EQ(told.at("batch"), "128");
  EXPECT_EQ(told.at("folds"), "3");
  EXPECT_EQ(told.at("folds_by"), "run");
}

TEST(TrainClassifier, HasTheGridOfThePapers) {
  const auto grid = paper_grid(standard_settings(Question::body));
  EXPECT_EQ(grid.size(), 80U);
  EXPECT_EQ(grid.front().hidden, (std::vector<int>{10, 10}));
  EXPECT_EQ(grid.back().hidden, (std::vector<int>{30, 30, 30, 30, 30}));
  EXPECT_EQ(grid.back().l2, 0.1);
}

TEST(TrainClassifier, SaysWhyItCannotLearn) {
  DataSet data = test::contact_examples(40, 1);
  std::erase_if(data.samples, [](const DataSample& sample) { return sample.touched >= 7; });
  EXPECT_THAT(test::problems_of([&] { train_classifier(data, quick(Question::chain)); }),
              testing::ElementsAre("the data hold fewer than two of the classes that 'chain' is about"));
  data.samples.resize(2);
  EXPECT_THAT(test::problems_of([&] { train_classifier(data, quick(Question::body)); }),
              testing::ElementsAre("there are 2 runs to learn from; 3 folds need at least as many"));
}

TEST(LeastWrench, IsThatOfWhichATwentiethOfTheSamplesIsSmaller) {
  DataSet data = test::contact_examples(100, 1);
  std::vector<std::size_t> samples;
  for (std::size_t i = 0; i < 100; ++i) {
    data.samples[i].course.front().wrench_in_base =
        Eigen::Vector3d(2.0 * static_cast<double>(100 - i), 0.0, 0.0);
    samples.push_back(i);
  }
  EXPECT_NEAR(least_wrench_of(data, samples), 6.0, 1e-12);  // 1 to 5 are smaller
  EXPECT_EQ(least_wrench_of(data, {}), 0.0);
}

TEST(FeaturesFor, RefusesOtherRobotsAndFeaturesInAnotherOrder) {
  const DataSet data = test::contact_examples(100, 1);
  ClassifierTraining training = quick(Question::body);
  training.candidates.front().epochs = 1;
  const ClassifierModel model = train_classifier(data, training).model;
  EXPECT_EQ(features_for(model, data).names(), model.features);

  DataSet other = data;
  const std::size_t mass = other.robot_text.find("  mass_kg: ");
  other.robot_text.insert(mass + 11, "1");
  EXPECT_THAT(test::problems_of([&] { features_for(model, other); }),
              testing::ElementsAre(testing::HasSubstr("train it anew with data of this robot")));

  ClassifierModel swapped = model;
  std::swap(swapped.features[0], swapped.features[1]);
  EXPECT_THAT(
      test::problems_of([&] { features_for(swapped, data); }),
      testing::ElementsAre("feature 1 of the model is 'force_y' and must be 'force_x'; a network is told "
                           "numbers by their place"));
  swapped = model;
  swapped.classes.pop_back();
  EXPECT_THAT(
      test::problems_of([&] { features_for(swapped, data); }),
      testing::ElementsAre(testing::StartsWith("class 7 of the model is missing and must be 'leg3_link2'")));
  swapped.provenance.erase("question");
  EXPECT_THAT(test::problems_of([&] { features_for(swapped, data); }),
              testing::ElementsAre(testing::HasSubstr("do not say which question it answers")));
}

ClassifierModel learned_from(const std::map<std::string, std::string>& provenance) {
  ClassifierModel model;
  model.provenance = provenance;
  return model;
}

TEST(WarningOfLearned, KnowsDataByTheirFileAndByTheirTitleAndSeed) {
  DataSet data = test::contact_examples(1, 1);  // title "Examples", seed 1
  data.sha256 = "abc";
  const auto warning = [&data](const std::map<std::string, std::string>& provenance) {
    return warning_of_learned(learned_from(provenance), data, {});
  };
  EXPECT_EQ(warning({{"data.sha256", "abc"}}),
            "the model has learned from these data; the figures tell what it remembers, not how well it does "
            "with contacts that are new to it");
  EXPECT_THAT(warning({{"data.title", "Examples"}, {"data.seed", "1"}}),
              testing::StartsWith("the model has learned from data of the same title and seed; "));
  EXPECT_EQ(warning({{"data.sha256", "abd"}}), "");
  EXPECT_EQ(warning({{"data.title", "Examples"}, {"data.seed", "2"}}), "");
  EXPECT_EQ(warning({{"data.title", "Others"}, {"data.seed", "1"}}), "");
  EXPECT_EQ(warning({}), "") << "a model that does not say";
  data.sha256.clear();
  data.card.erase("seed");
  EXPECT_EQ(warning({{"data.sha256", ""}, {"data.title", "Examples"}, {"data.seed", ""}}), "")
      << "recordings";
}

TEST(WarningOfLearned, IsNotGivenForOtherConfigurations) {
  const DataSet data = test::contact_examples(1, 1);
  const ClassifierModel model =
      learned_from({{"data.title", "Examples"}, {"data.seed", "1"}, {"data.configurations", "0, 12"}});
  EXPECT_EQ(warning_of_learned(model, data, {1, 2}), "");
  EXPECT_NE(warning_of_learned(model, data, {2, 12}), "");
  EXPECT_NE(warning_of_learned(model, data, {}), "");
}

}  // namespace
}  // namespace flinch
