#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "learning/data_set.h"
#include "learning/train_network.h"
#include "systems/contact/touch_hypotheses.h"
#include "systems/contact/wrench_uncertainty.h"

namespace flinch {

/// What a classifier is asked.
enum class Question {
  touched,   ///< which body, or which gap: all classes at once, by evidence of the model
  body,      ///< which body a collision is with, [SafePR] III-C
  clamping,  ///< whether a leg is clamped, [SafePR] III-E1
  chain,     ///< which leg is clamped, [SafePR] III-E2
};

/// "touched", "body", "clamping", "chain".
std::string name_of(Question question);
/// Throws SetupError with the names that there are.
Question question_named(const std::string& name);

/// What a classifier is told of a contact, and which answers it has.
class FeatureSet {
 public:
  FeatureSet(Question question, std::shared_ptr<const ParallelRobot> robot);

  Question question() const { return question_; }
  const std::vector<std::string>& classes() const { return classes_; }
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<std::string>& units() const { return units_; }
  int rows() const { return question_ == Question::touched ? static_cast<int>(classes_.size()) : 1; }
  int outputs() const { return question_ == Question::touched ? 1 : static_cast<int>(classes_.size()); }

  /// The right answer for what was touched; none where it is not asked about that.
  std::optional<int> answer(int touched) const;

  /// A short text that changes where the same contact is told by other numbers: by another robot, or by
  /// another version of what the features are made of.
  std::string check() const;

  /// A column for each row of the question. False where the sample tells nothing.
  bool inputs(const DataSample& sample, NeuralNetwork::Values& columns) const;

 private:
  Question question_;
  std::shared_ptr<const ParallelRobot> robot_;
  ContactClasses touchable_;
  TouchHypotheses hypotheses_;
  WrenchUncertainty uncertainty_;
  std::vector<std::string> classes_, names_, units_;
};

/// Which samples of a data set are looked at.
struct SampleFilter {
  int moments = 0;                  ///< sum of Moment's, any of which a sample must be; 0: all samples
  std::vector<int> configurations;  ///< empty: all
  bool chooses(const DataSample& sample) const;
};

/// Questions about a data set, and the sample that each is about.
struct Questions {
  TrainingSet set;
  std::vector<std::size_t> samples;
};

/// Every sample that the filter chooses as a question. All samples of a run together count as much as those
/// of another; with `balanced`, all samples of a class as much as those of another besides. Groups are runs.
/// On `threads` threads (0: one a processor).
Questions questions_of(const DataSet& data, const FeatureSet& features, const SampleFilter& filter,
                       bool balanced, std::size_t threads = 0);

}  // namespace flinch
