#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "learning/feature_set.h"

namespace flinch {

/// What a classifier answered to one question, and what would have been right.
struct Answered {
  std::size_t sample = 0;  ///< of the data set
  int configuration = 0;
  int right = 0;
  Eigen::VectorXd probability;  ///< of each class; empty: no answer
  bool believable = true;       ///< false: about a smaller wrench than the model has learned from

  int given() const;  ///< the most likely class; -1: none
  double confidence() const;
};

/// Answers of `network` to all questions. Throws SetupError where the questions are not of its size.
std::vector<Answered> answers_of(const NeuralNetwork& network, const Questions& questions,
                                 const DataSet& data);

/// Marks the answers about wrenches of less than the size `least_wrench` (WrenchUncertainty::size).
void disbelieve_small(std::vector<Answered>& answers, const DataSet& data, double least_wrench);

/// How often what was right was given as what.
struct Confusion {
  std::vector<std::string> classes;
  Eigen::MatrixXd counts;  ///< row: right, column: given; what got no answer is in `unanswered`
  std::size_t unanswered = 0;

  Eigen::MatrixXd row_normalised() const;  ///< rows without questions are 0
  /// Mean over the classes that occur of the share that was right.
  std::optional<double> balanced_accuracy() const;
};

/// `classes`: what answers 0, 1, ... are. `of`: which class of these each answer belongs to, as where only
/// collision and clamping are told apart; -1: it is not asked about. Probabilities of answers of one class
/// are added up; others do not count.
Confusion confusion_of(const std::vector<Answered>& answers, const std::vector<std::string>& classes,
                       const std::vector<int>& of);

/// One bar of a reliability diagram: answers of a confidence, and how many of them were right.
struct ReliabilityBin {
  double from = 0.0, to = 0.0;
  std::size_t count = 0;
  double confidence = 0.0, accuracy = 0.0;  ///< means
};
std::vector<ReliabilityBin> reliability_of(const std::vector<Answered>& answers, int bins = 10);

/// Mean of |accuracy - confidence| of the bins, by their counts. Guo et al., ICML 2017.
double expected_calibration_error(const std::vector<ReliabilityBin>& bins);

/// What is left when answers below a confidence are rejected.
struct RejectPoint {
  double accepted_from = 0.0;
  double rejected = 0.0;           ///< share of all
  double wrong_of_accepted = 0.0;  ///< 0 where nothing is accepted
};
/// What is not believable is rejected at any confidence.
RejectPoint reject_at(const std::vector<Answered>& answers, double accepted_from);
/// The same where the share `rejected` of the answers is, those that are least sure; at most that share.
RejectPoint reject_share(const std::vector<Answered>& answers, double rejected);
/// Nothing, 1, 2, ... 99 % of the answers rejected.
std::vector<RejectPoint> reject_curve(const std::vector<Answered>& answers);

/// The least confidence from which on at most the share `wrong` of what is accepted is wrong.
double acceptance_for(const std::vector<Answered>& answers, double wrong);

/// How well a classifier answers questions about a data set.
struct Evaluation {
  std::string moment;  ///< "early", "detected", "later", "all"
  std::size_t samples = 0;
  Confusion confusion;                                      ///< of its own classes
  std::vector<std::pair<int, Confusion>> by_configuration;  ///< where there are at most ten
  /// Of what it can tell: right body of collisions, collision against clamping, right leg of clampings; each
  /// balanced over its classes. The two after it: share of collisions, of clampings told as such.
  std::optional<double> body, collision_clamping, chain, collision, clamping;
  std::vector<ReliabilityBin> reliability;
  double calibration_error = 0.0;
  std::vector<RejectPoint> rejects;
  RejectPoint accepted;  ///< at the confidence that the model asks for
  RejectPoint at_tenth;  ///< where one answer in ten is rejected
};

Evaluation evaluate(const std::vector<Answered>& answers, const FeatureSet& features, double accepted_from,
                    const std::string& moment);

}  // namespace flinch
