#pragma once

#include <memory>

#include "diagrams/isolation_stages.h"
#include "systems/contact/evidence_features.h"

namespace flinch::test {

/// A classifier that takes all ten classes for equally likely, and names the first: the platform.
inline ContactClassifier unsure_classifier(double accept) {
  NetworkParameters parameters;
  parameters.layers.push_back(
      {Eigen::MatrixXd::Zero(1, evidence_feature_count), Eigen::VectorXd::Zero(1), Activation::none});
  parameters.result = NetworkResult::softmax_of_rows;
  return learned_classifier_stage({.network = std::make_shared<NeuralNetwork>(parameters), .accept = accept});
}

}  // namespace flinch::test
