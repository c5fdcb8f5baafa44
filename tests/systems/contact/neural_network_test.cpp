#include "systems/contact/neural_network.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <vector>

#include "systems/contact/rational_tanh.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "tests/support/allocations.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using Values = NeuralNetwork::Values;

Eigen::MatrixXd random_matrix(int rows, int columns, double size, RandomGenerator& random) {
  Eigen::MatrixXd matrix(rows, columns);
  for (double& value : matrix.reshaped()) value = size * random.normal();
  return matrix;
}

NetworkParameters random_network(const std::vector<int>& widths, Activation activation, NetworkResult result,
                                 RandomGenerator& random) {
  NetworkParameters network;
  network.mean = random_matrix(widths.front(), 1, 3.0, random);
  network.scale = random_matrix(widths.front(), 1, 1.0, random).cwiseAbs().array() + 0.1;
  for (std::size_t i = 1; i < widths.size(); ++i) {
    const bool is_last = i + 1 == widths.size();
    network.layers.push_back({random_matrix(widths[i], widths[i - 1], 0.5, random),
                              random_matrix(widths[i], 1, 0.5, random),
                              is_last ? Activation::none : activation});
  }
  network.result = result;
  return network;
}

// The tanh is compared with that of the library in a test of its own.
double activated(Activation activation, double x) {
  switch (activation) {
    case Activation::tanh:
      return rational_tanh(x);
    case Activation::relu:
      return x > 0.0 ? x : 0.0;
    case Activation::sigmoid:
      return 1.0 / (1.0 + std::exp(-x));
    case Activation::none:
      break;
  }
  return x;
}

/// The same network number by number, without a matrix.
std::vector<double> scores(const NetworkParameters& network, const Eigen::VectorXd& input) {
  std::vector<double> now(input.begin(), input.end());
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    now[i] = (now[i] - network.mean[k]) / network.scale[k];
  }
  for (const NetworkLayer& layer : network.layers) {
    std::vector<double> next;
    for (Eigen::Index row = 0; row < layer.weights.rows(); ++row) {
      double sum = layer.bias[row];
      for (std::size_t i = 0; i < now.size(); ++i)
        sum += layer.weights(row, static_cast<Eigen::Index>(i)) * now[i];
      next.push_back(activated(layer.activation, sum));
    }
    now = next;
  }
  return now;
}

std::vector<double> softmax(const std::vector<double>& scores) {
  std::vector<double> probabilities;
  for (const double own : scores) {
    double sum = 0.0;
    for (const double other : scores) sum += std::exp(other - own);
    probabilities.push_back(1.0 / sum);
  }
  return probabilities;
}

TEST(NeuralNetwork, ComputesWhatLoopsOverAllNumbersCompute) {
  RandomGenerator random(1);
  for (const Activation activation : {Activation::tanh, Activation::relu, Activation::sigmoid}) {
    const NetworkParameters parameters =
        random_network({12, 30, 30, 7}, activation, NetworkResult::softmax_of_outputs, random);
    const NeuralNetwork network(parameters);
    for (int trial = 0; trial < 20; ++trial) {
      const Values inputs = random_matrix(12, 3, 5.0, random);
      Values outputs;
      ASSERT_TRUE(network.evaluate(inputs, outputs));
      for (Eigen::Index row = 0; row < 3; ++row) {
        const std::vector<double> expected = softmax(scores(parameters, inputs.col(row)));
        for (std::size_t i = 0; i < 7; ++i)
          EXPECT_NEAR(outputs(static_cast<Eigen::Index>(i), row), expected[i], 1e-13);
      }
    }
  }
}

TEST(NeuralNetwork, ComparesRowsWhereTheyAnswerOneQuestion) {
  RandomGenerator random(2);
  const NetworkParameters parameters =
      random_network({5, 8, 1}, Activation::tanh, NetworkResult::softmax_of_rows, random);
  const Values inputs = random_matrix(5, 10, 3.0, random);
  Values outputs;
  ASSERT_TRUE(NeuralNetwork(parameters).evaluate(inputs, outputs));
  std::vector<double> each;
  for (Eigen::Index row = 0; row < 10; ++row) each.push_back(scores(parameters, inputs.col(row)).front());
  const std::vector<double> expected = softmax(each);
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_NEAR(outputs(0, static_cast<Eigen::Index>(i)), expected[i], 1e-13);
  EXPECT_NEAR(outputs.sum(), 1.0, 1e-14);
}

TEST(NeuralNetwork, AnswersHugeInputsWithProbabilitiesAndOthersNotAtAll) {
  RandomGenerator random(3);
  const NeuralNetwork network(
      random_network({4, 6, 3}, Activation::tanh, NetworkResult::softmax_of_outputs, random));
  Values outputs;
  for (const double huge : {1e6, -1e100, std::numeric_limits<double>::max()}) {
    const bool is_answered = network.evaluate(Values::Constant(4, 1, huge), outputs);
    if (!is_answered) continue;
    EXPECT_TRUE(outputs.allFinite()) << huge;
    EXPECT_NEAR(outputs.sum(), 1.0, 1e-14) << huge;
  }
  EXPECT_TRUE(network.evaluate(Values::Constant(4, 1, 1e6), outputs));
  for (const double broken :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Values inputs = Values::Zero(4, 1);
    inputs(2, 0) = broken;
    EXPECT_FALSE(network.evaluate(inputs, outputs));
    EXPECT_EQ(outputs.size(), 0);
  }
  EXPECT_FALSE(network.evaluate(Values::Zero(3, 1), outputs));
  EXPECT_FALSE(network.evaluate(Values::Zero(4, 0), outputs));
}

TEST(NeuralNetwork, GivesNoAnswerWhereItsSumsOverflow) {
  NetworkParameters parameters;
  parameters.layers.push_back(
      {Eigen::MatrixXd::Constant(2, 1, 1e300), Eigen::VectorXd::Zero(2), Activation::none});
  parameters.result = NetworkResult::softmax_of_outputs;
  Values outputs;
  EXPECT_FALSE(NeuralNetwork(parameters).evaluate(Values::Constant(1, 1, 1e300), outputs));
  EXPECT_EQ(outputs.size(), 0);
}

TEST(NeuralNetwork, DoesNotAllocate) {
  RandomGenerator random(4);
  const NeuralNetwork large(
      random_network({128, 128, 128, 128}, Activation::tanh, NetworkResult::softmax_of_outputs, random));
  const Values inputs = random_matrix(128, 32, 1.0, random);
  Values outputs;
  const test::AllocationCounter allocations;
  EXPECT_TRUE(large.evaluate(inputs, outputs));
  EXPECT_EQ(allocations.count(), 0);
}

TEST(NeuralNetwork, NamesAllThatIsWrongWithItsParameters) {
  RandomGenerator random(5);
  NetworkParameters parameters =
      random_network({4, 6, 3}, Activation::tanh, NetworkResult::softmax_of_rows, random);
  parameters.scale[1] = 0.0;
  parameters.layers[0].weights(0, 0) = std::numeric_limits<double>::quiet_NaN();
  parameters.layers[1].weights.setZero(3, 5);
  parameters.layers[1].bias.setZero(2);
  EXPECT_THAT(
      problems_with(parameters),
      testing::UnorderedElementsAre(
          "the standardisation has a scale that is not above 0", "layer 1 has weights that are not finite",
          "layer 2 takes 5 numbers and is given 6", "layer 2 has a bias of 2 numbers for 3 sums",
          "the network compares rows, and gives 3 numbers for each; it must be 1"));
  EXPECT_THROW(NeuralNetwork{parameters}, SetupError);
  EXPECT_EQ(problems_with(NetworkParameters()), std::vector<std::string>{"the network has no layer"});
  parameters = random_network({129, 2}, Activation::tanh, NetworkResult::values, random);
  EXPECT_THAT(problems_with(parameters),
              testing::ElementsAre("the network takes 129 numbers; it must be 1 to 128"));
}

}  // namespace
}  // namespace flinch
