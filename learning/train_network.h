#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "systems/contact/neural_network.h"

namespace flinch {

/// Questions with known answers. A question is one row of inputs, to which the network gives a number for
/// each class; or a row for each class, to which it gives one number each.
struct TrainingSet {
  int rows = 1;            ///< of a question
  Eigen::MatrixXf inputs;  ///< a column for each row of each question: features x (rows * questions)
  std::vector<int> answers;
  std::vector<float> weights;  ///< how much each question counts
  /// Questions of one group (a run, a configuration) are learned or tested together, never torn apart.
  std::vector<int> groups;

  std::size_t questions() const { return answers.size(); }
};

/// Those of the questions, in this order.
TrainingSet chosen(const TrainingSet& set, const std::vector<std::size_t>& questions);

struct TrainingSettings {
  std::vector<int> hidden = {24, 24};  ///< widths of the tanh layers, 1 to 5 of them
  /// Of the weights, not of the biases: half of it times the sum of their squares is added to the loss.
  double l2 = 1e-5;
  /// Inputs are divided by their standard deviations, but not by less than this: where all was learned in one
  /// pose, what hardly varied there would elsewhere be larger than anything that was seen.
  double least_scale = 0.0;
  double learning_rate = 3e-3;  ///< at first; it falls to 0 as half a cosine
  int epochs = 40;
  int batch = 256;
  std::uint64_t seed = 1;
};

/// All that is wrong with the settings, one sentence each.
std::vector<std::string> problems_with(const TrainingSettings& settings);

/// Told which share is done. Returns false to stop.
using TrainingProgress = std::function<bool(double share)>;

/// Trains a network on standardised inputs: tanh layers, softmax, cross entropy, Adam [SafePR] III. With the
/// same set, settings and machine it finds the same bits, whatever other threads do. `outputs`: classes, or 1
/// where a question has a row for each. Throws SetupError for sets or settings that cannot be trained with.
NetworkParameters train_network(const TrainingSet& set, int outputs, const TrainingSettings& settings,
                                const TrainingProgress& progress = {});

}  // namespace flinch
