#pragma once

#include <map>
#include <string>
#include <vector>

#include "systems/contact/neural_network.h"

namespace flinch {

/// A trained network, and what its numbers mean.
struct ClassifierModel {
  NetworkParameters network;
  std::vector<std::string> classes;   ///< in the order of the probabilities
  std::vector<std::string> features;  ///< in the order of the inputs
  std::vector<std::string> units;     ///< of the features; "1" for a plain number
  /// Below this probability an answer is not acted upon; 0: all are.
  double accepted_from = 0.0;
  /// Nor is one about a wrench of less than this size (WrenchUncertainty::size), of which it has not learned;
  /// 0: all are.
  double least_wrench = 0.0;
  /// What made it: robot, data, seed, version, settings.
  std::map<std::string, std::string> provenance;
};

/// All that is wrong with the model, one sentence each.
std::vector<std::string> problems_with(const ClassifierModel& model);

}  // namespace flinch
