#include "learning/onnx_graph.h"

#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

std::string sizes(const Eigen::MatrixXd& matrix) {
  return std::to_string(matrix.rows()) + " x " + std::to_string(matrix.cols());
}

/// A network while it is put together, node by node.
class Assembly {
 public:
  explicit Assembly(const OnnxGraph& graph) : graph_(graph), value_(graph.input) {}

  void add(const OnnxNode& node) {
    node_ = &node;
    if (node.type == "Identity" || node.type == "Cast") return hand_on();
    if (is_finished_) fail("stands after the softmax, which must be the last");
    if (node.type == "Gemm") return add_gemm();
    if (node.type == "MatMul") return add_product();
    if (node.type == "Add") return add_bias();
    if (node.type == "Sub") return standardise(parameters_.mean);
    if (node.type == "Div") return standardise(parameters_.scale);
    if (node.type == "Tanh") return activate(Activation::tanh);
    if (node.type == "Relu") return activate(Activation::relu);
    if (node.type == "Sigmoid") return activate(Activation::sigmoid);
    if (node.type == "Softmax") return finish();
    fail("is none of Sub, Div, Gemm, MatMul, Add, Tanh, Relu, Sigmoid, Softmax, Identity, Cast");
  }

  NetworkParameters take() {
    if (value_ != graph_.output) {
      throw SetupError("the graph gives '" + graph_.output + "', and its nodes compute '" + value_ + "'");
    }
    if (parameters_.layers.empty()) throw SetupError("the graph has no layer: no Gemm, no MatMul");
    complete_standardisation();
    return std::move(parameters_);
  }

 private:
  [[noreturn]] void fail(const std::string& complaint) const {
    throw SetupError("node '" + node_->name + "' (" + node_->type + ") " + complaint);
  }

  void need_inputs(std::size_t least, std::size_t most) const {
    if (node_->inputs.size() < least || node_->inputs.size() > most) {
      fail("has " + std::to_string(node_->inputs.size()) + " inputs; it must have " + std::to_string(least) +
           (least == most ? "" : " to " + std::to_string(most)));
    }
  }

  /// What comes in at `place` must be what the node before has computed.
  void need_value(std::size_t place = 0) const {
    if (node_->inputs[place] != value_) {
      fail("takes '" + node_->inputs[place] + "'; in a chain of layers it must take '" + value_ + "'");
    }
  }

  const OnnxTensor& constant(std::size_t place) const {
    const auto found = graph_.constants.find(node_->inputs[place]);
    if (found == graph_.constants.end()) fail("needs '" + node_->inputs[place] + "', which is no constant");
    return found->second;
  }

  double number(const std::string& name, double standard) const {
    const auto found = node_->numbers.find(name);
    return found == node_->numbers.end() ? standard : found->second;
  }

  /// A row of `count` numbers; one number stands for all of them.
  Eigen::VectorXd row(std::size_t place, Eigen::Index count) const {
    const Eigen::MatrixXd& values = constant(place).values;
    if (values.size() == 1) return Eigen::VectorXd::Constant(count, values(0, 0));
    if (values.rows() != 1 || values.cols() != count) {
      fail("has a constant '" + node_->inputs[place] + "' of " + sizes(values) + "; it must be 1 x " +
           std::to_string(count));
    }
    return values.row(0).transpose();
  }

  void pass_on() { value_ = node_->output; }

  /// The sums of a layer, which nothing has been done to yet.
  NetworkLayer& open_layer() {
    if (!is_open_) fail("stands where no layer is: it must follow a Gemm, a MatMul or an Add");
    return parameters_.layers.back();
  }

  void add_layer(const Eigen::MatrixXd& weights, const Eigen::VectorXd& bias) {
    if (weights.rows() > NeuralNetwork::max_width || weights.cols() > NeuralNetwork::max_width) {
      fail("has weights of " + sizes(weights) + "; at most " + std::to_string(NeuralNetwork::max_width) +
           " inputs and outputs are served");
    }
    if (!parameters_.layers.empty() && parameters_.layers.back().weights.rows() != weights.cols()) {
      fail("takes " + std::to_string(weights.cols()) + " numbers and is given " +
           std::to_string(parameters_.layers.back().weights.rows()));
    }
    if (!weights.allFinite() || !bias.allFinite()) fail("has weights that are not finite");
    parameters_.layers.push_back({weights, bias, Activation::none});
    is_open_ = true;
    is_product_ = false;
    pass_on();
  }

  void add_gemm() {
    need_inputs(2, 3);
    need_value();
    if (number("alpha", 1.0) != 1.0 || number("beta", 1.0) != 1.0) fail("has an alpha or beta that is not 1");
    if (number("transA", 0.0) != 0.0) fail("transposes its input");
    Eigen::MatrixXd weights = constant(1).values;
    if (number("transB", 0.0) == 0.0) weights.transposeInPlace();
    add_layer(weights,
              node_->inputs.size() == 3 ? row(2, weights.rows()) : Eigen::VectorXd::Zero(weights.rows()));
  }

  void add_product() {
    need_inputs(2, 2);
    need_value();
    const Eigen::MatrixXd weights = constant(1).values.transpose();
    add_layer(weights, Eigen::VectorXd::Zero(weights.rows()));
    is_product_ = true;
  }

  void add_bias() {
    need_inputs(2, 2);
    const std::size_t own = node_->inputs[0] == value_ ? 0 : 1;
    need_value(own);
    if (!is_product_) fail("adds something where there is no MatMul before it");
    NetworkLayer& layer = open_layer();
    layer.bias = row(1 - own, layer.bias.size());
    if (!layer.bias.allFinite()) fail("adds numbers that are not finite");
    is_product_ = false;
    pass_on();
  }

  void standardise(Eigen::VectorXd& constants) {
    need_inputs(2, 2);
    need_value();
    if (!parameters_.layers.empty()) fail("stands after a layer; it is served only before the first");
    if (constants.size() > 0 || (&constants == &parameters_.mean && parameters_.scale.size() > 0)) {
      fail("is not the standardisation (x - mean) / scale");
    }
    const Eigen::Index count = constant(1).values.size();
    if (count < 1 || count > NeuralNetwork::max_width)
      fail("has a constant of " + std::to_string(count) + " numbers");
    constants = row(1, count);
    if (!constants.allFinite()) fail("has a constant that is not finite");
    if (&constants == &parameters_.scale && !(constants.array() > 0.0).all())
      fail("divides by what is not above 0");
    pass_on();
  }

  /// A single number stands for all; what is left out does nothing.
  void complete_standardisation() {
    Eigen::VectorXd &mean = parameters_.mean, &scale = parameters_.scale;
    if (mean.size() == 0 && scale.size() == 0) return;
    const Eigen::Index inputs = parameters_.inputs();
    if (mean.size() == 0) mean.setZero(inputs);
    if (scale.size() == 0) scale.setOnes(inputs);
    if (mean.size() == 1) mean = Eigen::VectorXd::Constant(inputs, mean[0]);
    if (scale.size() == 1) scale = Eigen::VectorXd::Constant(inputs, scale[0]);
  }

  /// What other programs leave in a graph though it computes nothing.
  void hand_on() {
    need_inputs(1, 1);
    need_value();
    const double type = number("to", 1.0);
    if (type != 1.0 && type != 11.0) fail("makes other numbers than float (1) or double (11)");
    pass_on();
  }

  void activate(Activation activation) {
    need_inputs(1, 1);
    need_value();
    open_layer().activation = activation;
    is_open_ = is_product_ = false;
    pass_on();
  }

  void finish() {
    need_inputs(1, 1);
    need_value();
    open_layer();
    const double axis = number("axis", graph_.opset < 13 ? 1.0 : -1.0);
    if (axis != 0.0 && axis != 1.0 && axis != -1.0) fail("has an axis that is none of a matrix");
    parameters_.result = axis == 0.0 ? NetworkResult::softmax_of_rows : NetworkResult::softmax_of_outputs;
    is_finished_ = true;
    pass_on();
  }

  const OnnxGraph& graph_;
  const OnnxNode* node_ = nullptr;
  std::string value_;  ///< that the last node has computed
  NetworkParameters parameters_;
  bool is_open_ = false;     ///< nothing has been done to the sums of the last layer
  bool is_product_ = false;  ///< and they have no bias
  bool is_finished_ = false;
};

}  // namespace

NetworkParameters network_of(const OnnxGraph& graph) {
  Assembly assembly(graph);
  for (const OnnxNode& node : graph.nodes) assembly.add(node);
  return assembly.take();
}

}  // namespace flinch
