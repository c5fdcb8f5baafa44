#include "learning/onnx_file.h"

#include <google/protobuf/stubs/logging.h>
#include <onnx/onnx_pb.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "learning/onnx_graph.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/readable_file.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::uintmax_t largest_file = 64U << 20U;
constexpr int largest_tensor = NeuralNetwork::max_width * NeuralNetwork::max_width;
const std::string key_prefix = "flinch.";

// ---------------------------------------------------------------- writing

/// `values` as a tensor: a matrix row by row, or a vector.
template <class Values>
void add_constant(onnx::GraphProto& graph, const std::string& name, const Values& values, bool is_vector) {
  onnx::TensorProto& tensor = *graph.add_initializer();
  tensor.set_name(name);
  tensor.set_data_type(onnx::TensorProto::FLOAT);
  if (!is_vector) tensor.add_dims(values.rows());
  tensor.add_dims(is_vector ? values.size() : values.cols());
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (Eigen::Index j = 0; j < values.cols(); ++j) tensor.add_float_data(static_cast<float>(values(i, j)));
}

/// Adds nodes one after the other, each of which takes what the last one gave.
class Chain {
 public:
  explicit Chain(onnx::GraphProto& graph) : graph_(graph) {}

  onnx::NodeProto& add(const std::string& type, const std::string& name,
                       const std::vector<std::string>& constants = {}) {
    onnx::NodeProto& node = *graph_.add_node();
    node.set_op_type(type);
    node.set_name(name);
    node.add_input(value_);
    for (const std::string& constant : constants) node.add_input(constant);
    value_ = name;
    node.add_output(value_);
    return node;
  }
  void set_integer(onnx::NodeProto& node, const std::string& name, std::int64_t value) {
    onnx::AttributeProto& attribute = *node.add_attribute();
    attribute.set_name(name);
    attribute.set_type(onnx::AttributeProto::INT);
    attribute.set_i(value);
  }
  /// The last node gives the result of the graph.
  void finish(const std::string& output) {
    graph_.mutable_node(graph_.node_size() - 1)->set_output(0, output);
  }

 private:
  onnx::GraphProto& graph_;
  std::string value_ = "features";
};

const char* type_of(Activation activation) {
  switch (activation) {
    case Activation::tanh:
      return "Tanh";
    case Activation::relu:
      return "Relu";
    case Activation::sigmoid:
      return "Sigmoid";
    case Activation::none:
      break;
  }
  return nullptr;
}

void describe(onnx::ValueInfoProto& value, const std::string& name, int columns) {
  value.set_name(name);
  onnx::TypeProto::Tensor& tensor = *value.mutable_type()->mutable_tensor_type();
  tensor.set_elem_type(onnx::TensorProto::FLOAT);
  tensor.mutable_shape()->add_dim()->set_dim_param("rows");
  tensor.mutable_shape()->add_dim()->set_dim_value(columns);
}

void write_graph(const NetworkParameters& network, onnx::GraphProto& graph) {
  graph.set_name("classifier");
  describe(*graph.add_input(), "features", network.inputs());
  describe(*graph.add_output(), "probabilities", network.outputs());
  Chain chain(graph);
  if (network.mean.size() > 0) {
    add_constant(graph, "mean", network.mean, true);
    add_constant(graph, "scale", network.scale, true);
    chain.add("Sub", "centred", {"mean"});
    chain.add("Div", "standardised", {"scale"});
  }
  for (std::size_t i = 0; i < network.layers.size(); ++i) {
    const NetworkLayer& layer = network.layers[i];
    const std::string number = std::to_string(i + 1);
    add_constant(graph, "weights" + number, layer.weights, false);
    add_constant(graph, "bias" + number, layer.bias, true);
    chain.set_integer(chain.add("Gemm", "sums" + number, {"weights" + number, "bias" + number}), "transB", 1);
    if (const char* const type = type_of(layer.activation)) chain.add(type, "layer" + number);
  }
  if (network.result != NetworkResult::values) {
    const bool is_of_rows = network.result == NetworkResult::softmax_of_rows;
    chain.set_integer(chain.add("Softmax", "softmax"), "axis", is_of_rows ? 0 : 1);
  }
  chain.finish("probabilities");
}

void add_metadata(onnx::ModelProto& model, const std::string& key, const std::string& value) {
  onnx::StringStringEntryProto& entry = *model.add_metadata_props();
  entry.set_key(key_prefix + key);
  entry.set_value(value);
}

// ---------------------------------------------------------------- reading

template <class Number>
Number number_at(const std::string& bytes, std::size_t place) {
  Number value{};
  std::memcpy(&value, bytes.data() + place * sizeof(Number), sizeof(Number));
  return value;
}

/// The numbers of a tensor, row by row.
std::vector<double> numbers_of(const onnx::TensorProto& tensor, std::size_t count) {
  const bool is_float = tensor.data_type() == onnx::TensorProto::FLOAT;
  if (!is_float && tensor.data_type() != onnx::TensorProto::DOUBLE) {
    throw SetupError("has numbers of type " + std::to_string(tensor.data_type()) +
                     "; float (1) and double (11) are served");
  }
  if (tensor.external_data_size() > 0 || tensor.data_location() == onnx::TensorProto::EXTERNAL) {
    throw SetupError("has its numbers in another file; export the model as one file");
  }
  const std::string& raw = tensor.raw_data();
  const std::size_t size = is_float ? sizeof(float) : sizeof(double);
  const auto listed =
      static_cast<std::size_t>(is_float ? tensor.float_data_size() : tensor.double_data_size());
  const std::size_t found = raw.empty() ? listed : raw.size() / size;
  if (found != count || raw.size() % size != 0) {
    throw SetupError("has " + std::to_string(found) + " numbers for a size of " + std::to_string(count));
  }
  std::vector<double> numbers(count);
  for (std::size_t i = 0; i < count; ++i) {
    const int place = static_cast<int>(i);
    if (raw.empty()) {
      numbers[i] = is_float ? static_cast<double>(tensor.float_data(place)) : tensor.double_data(place);
    } else {
      numbers[i] = is_float ? static_cast<double>(number_at<float>(raw, i)) : number_at<double>(raw, i);
    }
  }
  return numbers;
}

OnnxTensor tensor_of(const onnx::TensorProto& tensor) {
  if (tensor.dims_size() > 2) {
    throw SetupError("has " + std::to_string(tensor.dims_size()) + " dimensions; at most 2 are served");
  }
  std::int64_t sizes[2] = {1, 1};  // rows and columns
  for (int i = 0; i < tensor.dims_size(); ++i) {
    const std::int64_t size = tensor.dims(i);
    if (size < 1 || size > largest_tensor) throw SetupError("has a dimension of " + std::to_string(size));
    sizes[2 - tensor.dims_size() + i] = size;
  }
  if (sizes[0] * sizes[1] > largest_tensor) {
    throw SetupError("has " + std::to_string(sizes[0] * sizes[1]) + " numbers; at most " +
                     std::to_string(largest_tensor) + " are served");
  }
  const std::vector<double> numbers = numbers_of(tensor, static_cast<std::size_t>(sizes[0] * sizes[1]));
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return {tensor.dims_size(), Eigen::Map<const RowMajor>(numbers.data(), sizes[0], sizes[1])};
}

void add_constant(const std::string& name, const onnx::TensorProto& tensor, OnnxGraph& graph) {
  graph.constants[name] = out_of("constant '" + name + "'", [&] { return tensor_of(tensor); });
}

OnnxNode node_of(const onnx::NodeProto& proto, int place) {
  OnnxNode node;
  node.name = proto.name().empty() ? "number " + std::to_string(place + 1) : proto.name();
  node.type = proto.op_type();
  node.inputs.assign(proto.input().begin(), proto.input().end());
  while (!node.inputs.empty() && node.inputs.back().empty())
    node.inputs.pop_back();  // ones that are left out
  if (proto.output_size() != 1) {
    throw SetupError("node '" + node.name + "' (" + node.type + ") gives " +
                     std::to_string(proto.output_size()) + " values; it must give 1");
  }
  node.output = proto.output(0);
  for (const onnx::AttributeProto& attribute : proto.attribute()) {
    if (attribute.type() == onnx::AttributeProto::INT) {
      node.numbers[attribute.name()] = static_cast<double>(attribute.i());
    } else if (attribute.type() == onnx::AttributeProto::FLOAT) {
      node.numbers[attribute.name()] = static_cast<double>(attribute.f());
    }
  }
  return node;
}

/// What a node "Constant" holds; null where it holds no tensor.
const onnx::TensorProto* constant_of(const onnx::NodeProto& node) {
  for (const onnx::AttributeProto& attribute : node.attribute()) {
    if (attribute.name() == "value" && attribute.has_t()) return &attribute.t();
  }
  return nullptr;
}

void require_one_output(const onnx::GraphProto& graph) {
  if (graph.output_size() == 1) return;
  std::vector<std::string> names;
  for (const onnx::ValueInfoProto& output : graph.output()) names.push_back("'" + output.name() + "'");
  throw SetupError(
      "the graph has " + std::to_string(names.size()) + " outputs" + (names.empty() ? "" : ": ") +
      listed(names) +
      "; it must have 1, the probabilities: leave out the others when exporting (skl2onnx: the option "
      "zipmap=False, then select_model_inputs_outputs(model, 'probabilities'))");
}

OnnxGraph graph_of(const onnx::ModelProto& model) {
  const onnx::GraphProto& proto = model.graph();
  OnnxGraph graph;
  for (const onnx::OperatorSetIdProto& opset : model.opset_import()) {
    if (opset.domain().empty()) graph.opset = static_cast<int>(opset.version());
  }
  for (const onnx::TensorProto& tensor : proto.initializer()) add_constant(tensor.name(), tensor, graph);
  for (const onnx::ValueInfoProto& input : proto.input()) {
    if (graph.constants.contains(input.name())) continue;  // which may be listed among the inputs
    if (!graph.input.empty())
      throw SetupError("the graph has several inputs: '" + graph.input + "', '" + input.name() + "'");
    graph.input = input.name();
  }
  require_one_output(proto);
  graph.output = proto.output(0).name();
  for (int i = 0; i < proto.node_size(); ++i) {
    const onnx::NodeProto& node = proto.node(i);
    const onnx::TensorProto* const constant = node.op_type() == "Constant" ? constant_of(node) : nullptr;
    if (constant && node.output_size() == 1) {
      add_constant(node.output(0), *constant, graph);
    } else {
      graph.nodes.push_back(node_of(node, i));
    }
  }
  return graph;
}

std::vector<std::string> names_in(const std::string& text, const std::string& key) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  std::vector<std::string> names;
  if (json.is_array() && json.size() <= NeuralNetwork::max_width) {
    for (const auto& name : json) {
      if (name.is_string()) names.push_back(name.get<std::string>());
    }
    if (names.size() == json.size()) return names;
  }
  throw SetupError("the metadata '" + key_prefix + key + "' is no list of names");
}

double number_in(const std::string& text, const std::string& key) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_number()) throw SetupError("the metadata '" + key_prefix + key + "' is no number");
  return json.get<double>();
}

void read_metadata(const onnx::ModelProto& proto, ClassifierModel& model) {
  for (const onnx::StringStringEntryProto& entry : proto.metadata_props()) {
    if (!entry.key().starts_with(key_prefix)) continue;
    const std::string key = entry.key().substr(key_prefix.size());
    if (key == "classes")
      model.classes = names_in(entry.value(), key);
    else if (key == "features")
      model.features = names_in(entry.value(), key);
    else if (key == "units")
      model.units = names_in(entry.value(), key);
    else if (key == "accepted_from")
      model.accepted_from = number_in(entry.value(), key);
    else if (key == "least_wrench")
      model.least_wrench = number_in(entry.value(), key);
    else
      model.provenance[key] = entry.value();
  }
  if (model.classes.empty() || model.features.empty() || model.units.empty()) {
    throw SetupError(
        "the metadata do not say what the numbers mean: 'flinch.classes', 'flinch.features' and "
        "'flinch.units' must be lists of names, such as [\"platform\", \"leg1_link1\"]");
  }
}

ClassifierModel model_of(const std::string& bytes) {
  const google::protobuf::LogSilencer silence;  // what is wrong is told by us
  onnx::ModelProto proto;
  if (bytes.empty() || !proto.ParseFromString(bytes)) {
    throw SetupError("this is no ONNX file, or only a part of one");
  }
  if (!proto.has_graph()) throw SetupError("the file holds no graph");
  ClassifierModel model;
  model.network = network_of(graph_of(proto));
  read_metadata(proto, model);
  throw_if_any(problems_with(model));
  return model;
}

}  // namespace

std::string onnx_bytes(const ClassifierModel& model) {
  throw_if_any(problems_with(model));
  onnx::ModelProto proto;
  proto.set_ir_version(7);
  proto.set_producer_name("flinch");
  proto.set_producer_version(FLINCH_VERSION);
  onnx::OperatorSetIdProto& opset = *proto.add_opset_import();
  opset.set_domain("");
  opset.set_version(13);
  write_graph(model.network, *proto.mutable_graph());
  add_metadata(proto, "classes", nlohmann::json(model.classes).dump());
  add_metadata(proto, "features", nlohmann::json(model.features).dump());
  add_metadata(proto, "units", nlohmann::json(model.units).dump());
  add_metadata(proto, "accepted_from", nlohmann::json(model.accepted_from).dump());
  add_metadata(proto, "least_wrench", nlohmann::json(model.least_wrench).dump());
  for (const auto& [key, value] : model.provenance) add_metadata(proto, key, value);
  return proto.SerializeAsString();
}

void write_onnx(const ClassifierModel& model, const std::filesystem::path& file) {
  write_result(file, onnx_bytes(model));
}

ClassifierModel read_onnx(const std::filesystem::path& file) {
  const std::string problem = problem_with_reading(file);
  if (!problem.empty()) throw SetupError(file.string() + ": " + problem);
  if (std::filesystem::file_size(file) > largest_file)
    throw SetupError(file.string() + ": is larger than any network that is served");
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream) throw SetupError(file.string() + ": the file cannot be read");
  return parse_onnx(bytes, file.string());
}

ClassifierModel parse_onnx(const std::string& bytes, const std::string& file) {
  return out_of(file, [&bytes] { return model_of(bytes); });
}

}  // namespace flinch
