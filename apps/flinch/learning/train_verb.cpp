// flinch train: a classifier from labelled contacts.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>

#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/stop_watch.h"
#include "learning/onnx_file.h"
#include "learning/train_classifier.h"
#include "systems/config/file_kind.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

volatile std::sig_atomic_t interrupted = 0;

/// `settings` with each number of epochs and L2 that is asked for, or each of the papers' grid.
std::vector<TrainingSettings> candidates_of(const TrainOptions& options, Question question,
                                            const TrainingSettings& settings) {
  SearchedSettings searched = searched_settings(question);
  if (options.grid) searched = {{settings.epochs}, {settings.l2}};
  if (!options.epochs.empty()) searched.epochs = options.epochs;
  if (!options.l2.empty()) searched.l2 = options.l2;
  std::vector<TrainingSettings> candidates;
  for (const TrainingSettings& each : combinations(settings, searched)) {
    throw_if_any(problems_with(each));
    const std::vector<TrainingSettings> more = options.grid ? paper_grid(each) : std::vector{each};
    candidates.insert(candidates.end(), more.begin(), more.end());
  }
  return candidates;
}

ClassifierTraining training_of(const TrainOptions& options) {
  ClassifierTraining training;
  training.question = out_of("--question", [&] { return question_named(options.question); });
  TrainingSettings settings = standard_settings(training.question);
  if (!options.hidden.empty()) settings.hidden = options.hidden;
  settings.least_scale = options.least_scale.value_or(settings.least_scale);
  settings.learning_rate = options.learning_rate.value_or(settings.learning_rate);
  settings.seed = options.seed.value_or(settings.seed);
  training.candidates = candidates_of(options, training.question, settings);
  training.folds = options.folds;
  training.folds_by = out_of("--folds-by", [&] { return folds_by_named(options.folds_by); });
  training.filter.configurations = options.configurations;
  training.threads = options.threads.value_or(0);
  return training;
}

void print_table(const TrainedClassifier& trained, const ClassifierTraining& training) {
  if (training.candidates.size() > 1) {
    print_result("{:>7} {:>6} {:>8} {:>7} {:>10} {:>14}\n", "layers", "width", "l2", "epochs", "accuracy",
                 "cross-entropy");
    for (std::size_t i = 0; i < training.candidates.size(); ++i) {
      const TrainingSettings& each = training.candidates[i];
      print_result("{:>7} {:>6} {:>8} {:>7} {:>8.2f} % {:>14.4f}\n", each.hidden.size(), each.hidden.front(),
                   each.l2, each.epochs, 100.0 * trained.accuracies[i], trained.losses[i]);
    }
  }
  const Evaluation& expected = trained.expected;
  print_result(
      "question:           {}\nhidden layers:      {}\nepochs:             {}\nsamples:            {}\n",
      name_of(training.question), fmt::join(trained.settings.hidden, ", "), trained.settings.epochs,
      expected.samples);
  print_result("accuracy:           {:.2f} %, balanced over classes, in {} folds that keep {}s together\n",
               100.0 * expected.confusion.balanced_accuracy().value_or(0.0), training.folds,
               name_of(training.folds_by));
  print_result("calibration error:  {:.4f} at temperature {:.3f}\n", expected.calibration_error,
               trained.temperature);
  print_result("accepted from:      {:.3f}; below are {:.1f} %, of the others {:.2f} % are wrong\n",
               expected.accepted.accepted_from, 100.0 * expected.accepted.rejected,
               100.0 * expected.accepted.wrong_of_accepted);
}

}  // namespace

ExitStatus train(const TrainOptions& options) {
  require_output(options.out, {options.data}, OutputKind::classifier);
  const ClassifierTraining training = training_of(options);
  require_no_kind(options.data, "a data set");
  const DataSet data = read_data_set(options.data);
  const StopWatch watch;
  TrainedClassifier trained;
  std::signal(SIGINT, [](int) { interrupted = 1; });
  {
    Progress progress("training", options.common.quiet || options.common.json);
    trained = out_of(options.data.string(), [&] {
      return train_classifier(data, training, [&progress](double share) {
        progress.show(share);
        return interrupted == 0;
      });
    });
  }
  std::signal(SIGINT, SIG_DFL);
  write_onnx(trained.model, options.out);
  if (options.common.json) {
    const Evaluation& expected = trained.expected;
    const nlohmann::ordered_json summary = {
        {"model", options.out.string()},
        {"question", name_of(training.question)},
        {"samples", expected.samples},
        {"hidden_layers", trained.settings.hidden},
        {"l2", trained.settings.l2},
        {"epochs", trained.settings.epochs},
        {"accuracy", expected.confusion.balanced_accuracy().value_or(0.0)},
        {"expected_calibration_error", expected.calibration_error},
        {"accepted_from", trained.model.accepted_from},
        {"wall_s", watch.seconds()}};
    print_result("{}\n", json_text(summary));
    return ExitStatus::done;
  }
  print_table(trained, training);
  if (!options.common.quiet) print_message("model:     {}\n", options.out.string());
  return ExitStatus::done;
}

}  // namespace flinch
