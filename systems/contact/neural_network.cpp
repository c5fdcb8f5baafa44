#include "systems/contact/neural_network.h"

#include <utility>

#include "systems/contact/rational_tanh.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Values = NeuralNetwork::Values;

void activate(Activation activation, Values& values) {
  switch (activation) {
    case Activation::none:
      return;
    case Activation::tanh:
      for (double& value : values.reshaped()) value = rational_tanh(value);
      return;
    case Activation::relu:
      values = values.cwiseMax(0.0);
      return;
    case Activation::sigmoid:
      values = (1.0 / (1.0 + (-values.array()).exp())).matrix();
      return;
  }
}

/// exp(z) / sum exp(z), where no exponent is above 0.
template <class Scores>
void soften(Scores&& scores) {
  scores.array() -= scores.maxCoeff();
  scores = scores.array().exp().matrix();
  scores /= scores.sum();
}

void finish(NetworkResult result, Values& values) {
  switch (result) {
    case NetworkResult::values:
      return;
    case NetworkResult::softmax_of_outputs:
      for (Eigen::Index row = 0; row < values.cols(); ++row) soften(values.col(row));
      return;
    case NetworkResult::softmax_of_rows:
      soften(values.row(0));
      return;
  }
}

void find_problems(const NetworkLayer& layer, Eigen::Index inputs, Findings& found) {
  const Eigen::Index rows = layer.weights.rows();
  found.require(layer.weights.cols() == inputs, "takes " + std::to_string(layer.weights.cols()) +
                                                    " numbers and is given " + std::to_string(inputs));
  found.require(rows >= 1 && rows <= NeuralNetwork::max_width, "gives " + std::to_string(rows) +
                                                                   " numbers; it must be 1 to " +
                                                                   std::to_string(NeuralNetwork::max_width));
  found.require(layer.bias.size() == rows, "has a bias of " + std::to_string(layer.bias.size()) +
                                               " numbers for " + std::to_string(rows) + " sums");
  found.require(layer.weights.allFinite() && layer.bias.allFinite(), "has weights that are not finite");
}

}  // namespace

std::vector<std::string> problems_with(const NetworkParameters& parameters) {
  Findings found;
  if (parameters.layers.empty()) return {"the network has no layer"};
  const Eigen::Index inputs = parameters.inputs();
  found.require(inputs >= 1 && inputs <= NeuralNetwork::max_width,
                "the network takes " + std::to_string(inputs) + " numbers; it must be 1 to " +
                    std::to_string(NeuralNetwork::max_width));
  const bool is_plain = parameters.mean.size() == 0 && parameters.scale.size() == 0;
  if (!is_plain) {
    found.require(parameters.mean.size() == inputs && parameters.scale.size() == inputs,
                  "the standardisation has " + std::to_string(parameters.mean.size()) + " means and " +
                      std::to_string(parameters.scale.size()) + " scales for " + std::to_string(inputs) +
                      " inputs");
    found.require(parameters.mean.allFinite() && parameters.scale.allFinite(),
                  "the standardisation has numbers that are not finite");
    found.require((parameters.scale.array() > 0.0).all(),
                  "the standardisation has a scale that is not above 0");
  }
  Eigen::Index width = inputs;
  for (std::size_t i = 0; i < parameters.layers.size(); ++i) {
    Findings of_layer("layer " + std::to_string(i + 1) + " ");
    find_problems(parameters.layers[i], width, of_layer);
    found.add_all(of_layer.take());
    width = parameters.layers[i].weights.rows();
  }
  found.require(parameters.result != NetworkResult::softmax_of_rows || parameters.outputs() == 1,
                "the network compares rows, and gives " + std::to_string(parameters.outputs()) +
                    " numbers for each; it must be 1");
  return found.take();
}

NeuralNetwork::NeuralNetwork(NetworkParameters parameters) : parameters_(std::move(parameters)) {
  throw_if_any(problems_with(parameters_));
}

bool NeuralNetwork::evaluate(const Values& inputs, Values& outputs) const noexcept {
  outputs.resize(0, 0);
  if (inputs.rows() != parameters_.inputs() || inputs.cols() < 1 || !inputs.allFinite()) return false;
  Values now = inputs, next;
  if (parameters_.mean.size() > 0) {
    now.colwise() -= parameters_.mean;
    now.array().colwise() /= parameters_.scale.array();
  }
  for (const NetworkLayer& layer : parameters_.layers) {
    next.resize(layer.weights.rows(), now.cols());
    for (Eigen::Index row = 0; row < now.cols(); ++row) {
      next.col(row) = layer.bias;
      next.col(row).noalias() += layer.weights * now.col(row);
    }
    activate(layer.activation, next);
    now.swap(next);
  }
  finish(parameters_.result, now);
  if (!now.allFinite()) return false;
  outputs = now;
  return true;
}

}  // namespace flinch
