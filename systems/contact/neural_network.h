#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace flinch {

/// What a layer does to each of its sums.
enum class Activation { none, tanh, relu, sigmoid };

/// y = activation(W x + b)
struct NetworkLayer {
  Eigen::MatrixXd weights;  ///< outputs x inputs
  Eigen::VectorXd bias;     ///< outputs
  Activation activation = Activation::none;
};

/// What becomes of the outputs of the last layer.
enum class NetworkResult {
  values,              ///< they are the result
  softmax_of_outputs,  ///< each row of inputs is one question: probabilities of its outputs
  softmax_of_rows,     ///< all rows are answers to one question, with one output each: their probabilities
};

/// A feed-forward network, as it stands in a file.
struct NetworkParameters {
  /// Inputs are standardised: (x - mean) / scale. Both empty: they are taken as they are.
  Eigen::VectorXd mean, scale;
  std::vector<NetworkLayer> layers;
  NetworkResult result = NetworkResult::values;

  int inputs() const { return layers.empty() ? 0 : static_cast<int>(layers.front().weights.cols()); }
  int outputs() const { return layers.empty() ? 0 : static_cast<int>(layers.back().weights.rows()); }
};

/// All that is wrong with the parameters, one sentence each: sizes that do not fit together or are too large,
/// numbers that are not finite, a scale that is not positive.
std::vector<std::string> problems_with(const NetworkParameters& parameters);

/// A feed-forward network that can be asked in a control loop: it neither allocates nor throws, and one
/// object serves many threads. [SafePR] III-C, III-E
class NeuralNetwork {
 public:
  static constexpr int max_width = 128;  ///< of inputs and of every layer
  static constexpr int max_rows = 32;    ///< of inputs that are asked about at once

  /// Inputs or outputs, one column for each row of the question.
  using Values = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_width, max_rows>;

  /// Throws SetupError with all problems.
  explicit NeuralNetwork(NetworkParameters parameters);

  const NetworkParameters& parameters() const { return parameters_; }

  /// Answers for each column of `inputs`. Returns false, and `outputs` of no size, where the inputs have the
  /// wrong size or are not finite, or where the answer is not finite.
  bool evaluate(const Values& inputs, Values& outputs) const noexcept;

 private:
  NetworkParameters parameters_;
};

}  // namespace flinch
