// How well a model does that has learned from some hundred runs only, as docs/theory.md says: by the same
// calls as the commands there.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "experiments/dataset/data_spec.h"
#include "experiments/dataset/make_data_set.h"
#include "learning/train_classifier.h"
#include "tests/campaign/classification/documented_figures.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

DataSet contacts(std::size_t runs, std::uint64_t seed) {
  const test::TemporaryFolder folder;
  return make_data_set(
      read_data_spec(FLINCH_SOURCE_DIR "/apps/models/bodies.yaml", {.runs = runs, .seed = seed}),
      folder / "data.h5");
}

/// Of the mean over the classes, each of which is a share of its samples.
double deviation_of(const Confusion& confusion) {
  double sum = 0.0, classes = 0.0;
  for (Eigen::Index i = 0; i < confusion.counts.rows(); ++i) {
    const double all = confusion.counts.row(i).sum(), right = confusion.counts(i, i);
    if (all == 0.0) continue;
    sum += right / all * (1.0 - right / all) / all;
    classes += 1.0;
  }
  return std::sqrt(sum) / classes;
}

TEST(SmallModel, TellsContactsAsWellAsIsStated) {
  const std::vector<double> stated = test::documented_row("600 runs:");
  ASSERT_EQ(stated.size(), 6U) << "three accuracies and their deviations, in percent";
  ClassifierTraining training;
  training.folds = 3;
  training.candidates = {standard_settings(Question::touched)};
  training.candidates.front().epochs = 20;
  const ClassifierModel model = train_classifier(contacts(600, 1), training).model;
  const DataSet data = contacts(400, 2);
  const FeatureSet features(Question::touched, data.robot);
  std::size_t column = 0;
  for (const int moment : {Moment::early, Moment::detected, Moment::later}) {
    const Questions questions = questions_of(data, features, {moment, {}}, false);
    const Confusion confusion =
        evaluate(answers_of(NeuralNetwork(model.network), questions, data), features, model.accepted_from, "")
            .confusion;
    const double found = 100.0 * confusion.balanced_accuracy().value_or(0.0);
    const double deviation = 100.0 * deviation_of(confusion);
    std::printf("%.1f %% with a deviation of %.1f %%, of %zu\n", found, deviation, questions.samples.size());
    EXPECT_NEAR(found, stated[column], 2.0 * stated[column + 1]);
    EXPECT_NEAR(deviation, stated[column + 1], 0.25 * stated[column + 1]);
    column += 2;
  }
}

}  // namespace
}  // namespace flinch
