// Networks in ONNX, asked once.
#include "learning/onnx_file.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/file_bytes.h"

namespace flinch::test {
namespace {

void try_onnx(std::string_view bytes) {
  const ClassifierModel model = parse_onnx(std::string(bytes), "fuzzed.onnx");
  const NeuralNetwork network(model.network);
  NeuralNetwork::Values outputs;
  network.evaluate(NeuralNetwork::Values::Ones(model.network.inputs(), 2), outputs);
  onnx_bytes(model);
}

std::vector<std::string> onnx_seeds() {
  ClassifierModel model;
  model.features = {"force", "distance"};
  model.units = {"N", "m"};
  model.classes = {"collision", "clamping"};
  model.accepted_from = 0.75;
  model.provenance = {{"robot", "bench"}};
  model.network.mean = Eigen::Vector2d(1.5, -2.0);
  model.network.scale = Eigen::Vector2d(2.0, 0.5);
  model.network.layers = {{.weights = Eigen::MatrixXd::Constant(3, 2, 0.5),
                           .bias = Eigen::VectorXd::Zero(3),
                           .activation = Activation::tanh},
                          {.weights = Eigen::MatrixXd::Constant(2, 3, 0.25),
                           .bias = Eigen::VectorXd::Ones(2),
                           .activation = Activation::none}};
  model.network.result = NetworkResult::softmax_of_outputs;
  return {onnx_bytes(model), bytes_of(FLINCH_SOURCE_DIR "/apps/models/bodies.onnx")};
}

}  // namespace

const FuzzTarget onnx_target{"onnx", try_onnx, onnx_seeds};

}  // namespace flinch::test
