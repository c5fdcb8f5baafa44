#include "learning/classifier_model.h"

#include <algorithm>

#include "systems/foundation/findings.h"

namespace flinch {
namespace {

void find_repetitions(std::vector<std::string> names, const std::string& what, Findings& found) {
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end()) found.add("the " + what + " '" + *twice + "' is named twice");
}

}  // namespace

std::vector<std::string> problems_with(const ClassifierModel& model) {
  Findings found;
  found.add_all(problems_with(model.network));
  const auto inputs = static_cast<std::size_t>(model.network.inputs());
  found.require(model.features.size() == inputs, "it names " + std::to_string(model.features.size()) +
                                                     " features for " + std::to_string(inputs) + " inputs");
  found.require(model.units.size() == model.features.size(),
                "it names " + std::to_string(model.units.size()) + " units for " +
                    std::to_string(model.features.size()) + " features");
  found.require(model.classes.size() >= 2, "it names fewer than two classes");
  if (model.network.result != NetworkResult::softmax_of_rows) {
    const auto outputs = static_cast<std::size_t>(model.network.outputs());
    found.require(model.classes.size() == outputs, "it names " + std::to_string(model.classes.size()) +
                                                       " classes for " + std::to_string(outputs) +
                                                       " outputs");
  } else {
    found.require(model.classes.size() <= static_cast<std::size_t>(NeuralNetwork::max_rows),
                  "it names more classes than can be compared");
  }
  found.require(model.accepted_from >= 0.0 && model.accepted_from <= 1.0,
                "the probability from which it is believed is not between 0 and 1");
  found.require(model.least_wrench >= 0.0, "the least wrench that it is believed about is negative");
  find_repetitions(model.features, "feature", found);
  find_repetitions(model.classes, "class", found);
  return found.take();
}

}  // namespace flinch
