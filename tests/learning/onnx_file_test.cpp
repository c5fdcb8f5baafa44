#include "learning/onnx_file.h"

#include <gmock/gmock.h>

#include <fstream>
#include <string>

#include "learning/onnx_graph.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

float any_float(RandomGenerator& random) { return static_cast<float>(random.normal()); }

ClassifierModel example(NetworkResult result = NetworkResult::softmax_of_outputs) {
  RandomGenerator random(1);
  ClassifierModel model;
  model.features = {"force", "distance", "angle"};
  model.units = {"N", "m", "rad"};
  model.classes = {"collision", "clamping"};
  model.accepted_from = 0.75;
  model.least_wrench = 4.5;
  model.provenance = {{"robot", "bench"}, {"seed", "7"}};
  model.network.mean = Eigen::Vector3d(1.5, -2.0, 0.25);
  model.network.scale = Eigen::Vector3d(2.0, 0.5, 1.0);
  const int outputs = result == NetworkResult::softmax_of_rows ? 1 : 2;
  for (const auto& [rows, columns] : {std::pair(4, 3), std::pair(5, 4), std::pair(outputs, 5)}) {
    NetworkLayer& layer = model.network.layers.emplace_back();
    layer.weights.resize(rows, columns);
    layer.bias.resize(rows);
    for (double& weight : layer.weights.reshaped()) weight = static_cast<double>(any_float(random));
    for (double& weight : layer.bias) weight = static_cast<double>(any_float(random));
    layer.activation = rows == outputs ? Activation::none : Activation::tanh;
  }
  model.network.result = result;
  return model;
}

TEST(OnnxFile, GivesBackWhatWasWritten) {
  for (const NetworkResult result :
       {NetworkResult::values, NetworkResult::softmax_of_outputs, NetworkResult::softmax_of_rows}) {
    const ClassifierModel model = example(result);
    const ClassifierModel read = parse_onnx(onnx_bytes(model), "model.onnx");
    EXPECT_EQ(read.classes, model.classes);
    EXPECT_EQ(read.features, model.features);
    EXPECT_EQ(read.units, model.units);
    EXPECT_EQ(read.accepted_from, model.accepted_from);
    EXPECT_EQ(read.least_wrench, model.least_wrench);
    EXPECT_EQ(read.provenance, model.provenance);
    EXPECT_EQ(read.network.mean, model.network.mean);
    EXPECT_EQ(read.network.scale, model.network.scale);
    EXPECT_EQ(read.network.result, model.network.result);
    ASSERT_EQ(read.network.layers.size(), model.network.layers.size());
    for (std::size_t i = 0; i < model.network.layers.size(); ++i) {
      EXPECT_EQ(read.network.layers[i].weights, model.network.layers[i].weights);
      EXPECT_EQ(read.network.layers[i].bias, model.network.layers[i].bias);
      EXPECT_EQ(read.network.layers[i].activation, model.network.layers[i].activation);
    }
    EXPECT_EQ(onnx_bytes(read), onnx_bytes(model));
  }
}

TEST(OnnxFile, SurvivesBytesThatChangeAndFilesThatEndEarly) {
  const std::string whole = onnx_bytes(example());
  RandomGenerator random(2);
  int served = 0, refused = 0;
  const auto read = [&](const std::string& bytes) {
    try {
      const ClassifierModel model = parse_onnx(bytes, "hostile.onnx");
      NeuralNetwork::Values outputs;
      const NeuralNetwork network(model.network);
      network.evaluate(NeuralNetwork::Values::Ones(model.network.inputs(), 2), outputs);
      ++served;
    } catch (const SetupError& error) {
      for (const std::string& problem : error.problems())
        ASSERT_TRUE(problem.starts_with("hostile.onnx: ")) << problem;
      ++refused;
    }
  };
  for (std::size_t length = 0; length < whole.size(); ++length) read(whole.substr(0, length));
  for (int trial = 0; trial < 8000; ++trial) {
    std::string bytes = whole;
    for (std::uint64_t i = 0; i <= random() % 4; ++i)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    read(bytes);
  }
  EXPECT_GE(refused, static_cast<int>(whole.size()) / 2);
  EXPECT_GT(served, 100);  // a weight may be any number
}

TEST(OnnxFile, RefusesFilesThatAreNone) {
  EXPECT_THAT(test::problems_of([] { parse_onnx("", "model.onnx"); }),
              testing::ElementsAre("model.onnx: this is no ONNX file, or only a part of one"));
  EXPECT_THAT(test::problems_of([] { parse_onnx("flinch", "model.onnx"); }),
              testing::ElementsAre("model.onnx: this is no ONNX file, or only a part of one"));
  EXPECT_THAT(test::problems_of([] { read_onnx("no/such.onnx"); }),
              testing::ElementsAre("no/such.onnx: there is no such file"));
}

TEST(OnnxFile, RefusesToWriteAModelThatIsNotWhole) {
  ClassifierModel model = example();
  model.features.pop_back();
  model.classes = {"collision", "collision"};
  EXPECT_THAT(test::problems_of([&] { onnx_bytes(model); }),
              testing::ElementsAre("it names 2 features for 3 inputs", "it names 3 units for 2 features",
                                   "the class 'collision' is named twice"));
}

TEST(OnnxFile, NamesTheOutputsWhereThereAreSeveral) {
  // Messages that follow one another are merged: ModelProto.graph (7) with a GraphProto.output (12) more.
  const std::string label = "\x3a\x09\x62\x07\x0a\x05label";
  EXPECT_THAT(
      test::problems_of([&] { parse_onnx(onnx_bytes(example()) + label, "model.onnx"); }),
      testing::ElementsAre(
          "model.onnx: the graph has 2 outputs: 'probabilities', 'label'; it must have 1, the "
          "probabilities: leave out the others when exporting (skl2onnx: the option zipmap=False, then "
          "select_model_inputs_outputs(model, 'probabilities'))"));
}

// ---------------------------------------------------------------- graphs of other programs

OnnxTensor tensor(const Eigen::MatrixXd& values) { return {2, values}; }

/// x -> (x - 1) / 2 -> MatMul, Add, Relu -> Gemm without transposition -> Softmax.
OnnxGraph foreign() {
  OnnxGraph graph;
  graph.input = "x";
  graph.output = "y";
  graph.constants = {{"one", tensor(Eigen::MatrixXd::Constant(1, 1, 1.0))},
                     {"two", tensor(Eigen::MatrixXd::Constant(1, 1, 2.0))},
                     {"w1", tensor((Eigen::MatrixXd(2, 3) << 1, 2, 3, 4, 5, 6).finished())},
                     {"b1", tensor(Eigen::RowVector3d(0.5, -0.5, 0.25))},
                     {"w2", tensor((Eigen::MatrixXd(3, 2) << 1, 0, 0, 1, 1, -1).finished())}};
  graph.nodes = {{"/scaler/Sub", "Sub", {"x", "one"}, "a", {}},
                 {"/scaler/Div", "Div", {"a", "two"}, "b", {}},
                 {"/0/MatMul", "MatMul", {"b", "w1"}, "c", {}},
                 {"/0/Add", "Add", {"b1", "c"}, "d", {}},
                 {"/1/Relu", "Relu", {"d"}, "e", {}},
                 {"/2/Gemm", "Gemm", {"e", "w2"}, "f", {}},
                 {"/3/Softmax", "Softmax", {"f"}, "y", {{"axis", -1.0}}}};
  return graph;
}

TEST(OnnxGraph, ComputesWhatItsNodesSay) {
  const NetworkParameters network = network_of(foreign());
  NeuralNetwork::Values outputs;
  ASSERT_TRUE(NeuralNetwork(network).evaluate(Eigen::Vector2d(3.0, -1.0), outputs));
  // By hand: standardised (1, -1); sums (1-4, 2-5, 3-6) + b = (-2.5, -3.5, -2.75); all below 0 after Relu.
  EXPECT_NEAR(outputs(0, 0), 0.5, 1e-15);
  ASSERT_TRUE(NeuralNetwork(network).evaluate(Eigen::Vector2d(3.0, 2.0), outputs));
  // (1, 0.5): (1+2, 2+2.5, 3+3) + b = (3.5, 4, 6.25); outputs (9.75, -2.25).
  EXPECT_NEAR(outputs(0, 0), 1.0 / (1.0 + std::exp(-12.0)), 1e-14);
}

TEST(OnnxGraph, ServesTheLayoutOfScikitLearnsNetworks) {
  OnnxGraph graph = foreign();
  graph.nodes.front().inputs.front() = "cast_input";
  graph.nodes.insert(graph.nodes.begin(), {"Cast", "Cast", {"x"}, "cast_input", {{"to", 1.0}}});
  graph.nodes.back().output = "out_activations_result";
  graph.nodes.push_back({"Identity", "Identity", {"out_activations_result"}, "y", {}});
  const NeuralNetwork network(network_of(graph)), same(network_of(foreign()));
  NeuralNetwork::Values outputs, wanted;
  ASSERT_TRUE(network.evaluate(Eigen::Vector2d(3.0, 2.0), outputs));
  ASSERT_TRUE(same.evaluate(Eigen::Vector2d(3.0, 2.0), wanted));
  EXPECT_EQ(outputs, wanted);
  graph.nodes.front().numbers["to"] = 7.0;
  EXPECT_THAT(test::problems_of([&] { network_of(graph); }),
              testing::ElementsAre("node 'Cast' (Cast) makes other numbers than float (1) or double (11)"));
}

TEST(OnnxGraph, NamesTheNodeThatItDoesNotServe) {
  const auto problem = [](auto&& spoil) {
    OnnxGraph graph = foreign();
    spoil(graph);
    return test::problems_of([&] { network_of(graph); }).front();
  };
  EXPECT_EQ(problem([](OnnxGraph& g) { g.nodes[4].type = "Gelu"; }),
            "node '/1/Relu' (Gelu) is none of Sub, Div, Gemm, MatMul, Add, Tanh, Relu, Sigmoid, Softmax, "
            "Identity, Cast");
  EXPECT_EQ(problem([](OnnxGraph& g) { g.nodes[5].numbers["alpha"] = 0.5; }),
            "node '/2/Gemm' (Gemm) has an alpha or beta that is not 1");
  EXPECT_EQ(problem([](OnnxGraph& g) { g.nodes[5].numbers["transB"] = 1.0; }),
            "node '/2/Gemm' (Gemm) takes 2 numbers and is given 3");
  EXPECT_EQ(problem([](OnnxGraph& g) { g.nodes[5].inputs[0] = "b"; }),
            "node '/2/Gemm' (Gemm) takes 'b'; in a chain of layers it must take 'e'");
  EXPECT_EQ(problem([](OnnxGraph& g) { g.nodes[2].inputs[1] = "x"; }),
            "node '/0/MatMul' (MatMul) needs 'x', which is no constant");
  EXPECT_EQ(problem([](OnnxGraph& g) { g.nodes[4].inputs.clear(); }),
            "node '/1/Relu' (Relu) has 0 inputs; it must have 1");
  EXPECT_EQ(problem([](OnnxGraph& g) { g.constants["b1"] = tensor(Eigen::RowVector2d(1, 2)); }),
            "node '/0/Add' (Add) has a constant 'b1' of 1 x 2; it must be 1 x 3");
  EXPECT_EQ(problem([](OnnxGraph& g) { g.constants["two"].values(0, 0) = 0.0; }),
            "node '/scaler/Div' (Div) divides by what is not above 0");
  EXPECT_EQ(problem([](OnnxGraph& g) { g.constants["w1"].values(0, 0) = std::nan(""); }),
            "node '/0/MatMul' (MatMul) has weights that are not finite");
  EXPECT_EQ(problem([](OnnxGraph& g) { std::swap(g.nodes[5], g.nodes[6]); }),
            "node '/3/Softmax' (Softmax) takes 'f'; in a chain of layers it must take 'e'");
  EXPECT_EQ(problem([](OnnxGraph& g) { g.nodes.pop_back(); }),
            "the graph gives 'y', and its nodes compute 'f'");
  EXPECT_EQ(problem([](OnnxGraph& g) { g.nodes[3].type = "Sub"; }),
            "node '/0/Add' (Sub) takes 'b1'; in a chain of layers it must take 'c'");
  EXPECT_EQ(problem([](OnnxGraph& g) {
              g.nodes.clear();
              g.output = "x";
            }),
            "the graph has no layer: no Gemm, no MatMul");
}

}  // namespace
}  // namespace flinch
