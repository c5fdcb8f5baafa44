#pragma once

#include <functional>
#include <string>
#include <vector>

#include "learning/classifier_model.h"
#include "learning/evaluation.h"

namespace flinch {

/// What a fold keeps together. By run a cross-validation tells how well contacts are told where others were
/// learned from in the same configuration; by configuration, where none was.
enum class FoldsBy { run, configuration };

/// "run", "configuration".
std::string name_of(FoldsBy folds_by);
/// Throws SetupError with the names that there are.
FoldsBy folds_by_named(const std::string& name);

/// How a classifier is made from a data set.
struct ClassifierTraining {
  Question question = Question::touched;
  std::vector<TrainingSettings> candidates;  ///< that of least `losses` is taken; one: no search
  int folds = 5;                             ///< of the cross-validation
  FoldsBy folds_by = FoldsBy::run;           ///< of which none is in two folds
  SampleFilter filter;
  /// Largest share of wrong answers among those that are believed; from which confidence on that holds is
  /// found in the cross-validation.
  double wrong_of_accepted = 0.01;
  std::size_t threads = 0;  ///< 0: one a processor
};

/// The settings of [SafePR] V-F1: 5 x 30 for clamping, 5 x 25 for the chain; for the body 4 x 30, whose
/// widths are not printed. Ours for `touched`.
TrainingSettings standard_settings(Question question);

/// Passes through the data and weights of the squared weights, among which a cross-validation chooses where
/// nobody says: several for the papers' questions, for they do not print theirs. One for `touched`.
struct SearchedSettings {
  std::vector<int> epochs;
  std::vector<double> l2;
};
SearchedSettings searched_settings(Question question);

/// `base` with each of these, the L2 of each number of epochs one after the other.
std::vector<TrainingSettings> combinations(const TrainingSettings& base, const SearchedSettings& searched);

/// The grid of [SafePR] V-F: 2 to 5 hidden layers of 10 to 30, L2 from 1e-4 to 1e-1.
std::vector<TrainingSettings> paper_grid(const TrainingSettings& base);

/// What came out of a training.
struct TrainedClassifier {
  ClassifierModel model;
  TrainingSettings settings;       ///< that were best
  std::vector<double> accuracies;  ///< balanced, of each candidate in cross-validation
  /// Cross-entropy of each candidate in cross-validation, the mean over the classes: it grows where a network
  /// has learned for too long, and is surer than right.
  std::vector<double> losses;
  double temperature = 1.0;  ///< that the scores were divided by
  Evaluation expected;       ///< by the cross-validation
};

/// The size (WrenchUncertainty::size) that 19 of 20 wrenches of `samples` have at least; 0 without any.
double least_wrench_of(const DataSet& data, const std::vector<std::size_t>& samples);

/// Trains in folds that keep runs, or configurations, together: each candidate on all folds but one, asked
/// about that one. From the answers of the one of least cross-entropy come temperature (Guo et al., ICML
/// 2017) and acceptance; then it is trained on all. The same bits for any number of threads. Throws
/// SetupError for data that cannot be learned from.
TrainedClassifier train_classifier(const DataSet& data, const ClassifierTraining& training,
                                   const TrainingProgress& progress = {});

}  // namespace flinch
