#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "systems/contact/neural_network.h"

namespace flinch {

/// An ONNX graph of the few sorts that a feed-forward network needs, without a type of ONNX.

/// A constant: a vector is a matrix of one row.
struct OnnxTensor {
  int dimensions = 0;  ///< 0, 1 or 2
  Eigen::MatrixXd values;
};

/// One operation: what it does to which values, by their names.
struct OnnxNode {
  std::string name;  ///< for people; its place where it has none
  std::string type;  ///< "Gemm"
  std::vector<std::string> inputs;
  std::string output;
  /// Numbers among its attributes.
  std::map<std::string, double> numbers;
};

/// Nodes in the order of the file.
struct OnnxGraph {
  std::string input, output;
  std::map<std::string, OnnxTensor> constants;
  std::vector<OnnxNode> nodes;
  int opset = 13;
};

/// The network that the graph computes. Throws SetupError naming the node that is none of those that
/// read_onnx() knows, or has the wrong sizes, inputs or place.
NetworkParameters network_of(const OnnxGraph& graph);

}  // namespace flinch
