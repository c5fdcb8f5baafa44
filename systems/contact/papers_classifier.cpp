#include "systems/contact/papers_classifier.h"

#include <string>
#include <utility>

#include "systems/contact/feature_extraction.h"
#include "systems/contact/wrench_uncertainty.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

void check(const std::shared_ptr<const NeuralNetwork>& network, const std::string& question, int inputs,
           int answers, Findings& found) {
  if (!network) {
    found.add("there is no network for the question '" + question + "'");
    return;
  }
  const NetworkParameters& has = network->parameters();
  found.require(
      has.inputs() == inputs && has.outputs() == answers && has.result == NetworkResult::softmax_of_outputs,
      "the network for the question '" + question + "' must make " + std::to_string(answers) +
          " probabilities of " + std::to_string(inputs) + " inputs");
}

}  // namespace

PapersClassifier::PapersClassifier(const std::shared_ptr<const ParallelRobot>& robot,
                                   PapersClassifierSettings settings)
    : space_(robot->space()), classes_(robot->body_count(), robot->legs()), settings_(std::move(settings)) {
  Findings found("papers classifier: ");
  const int few = robot->dof() + robot->legs();
  check(settings_.clamping, "clamping", few, 2, found);
  check(settings_.chain, "chain", few, classes_.legs(), found);
  check(settings_.body, "body", few + robot->drives() + robot->legs(), classes_.bodies(), found);
  found.require(settings_.accept >= 0.0 && settings_.accept <= 1.0, "accept must be between 0 and 1");
  found.not_negative("least_wrench", settings_.least_wrench);
  throw_if_any(found.take());
}

bool PapersClassifier::ask(const ContactFeatures& seen, ClassVector& probability) const noexcept {
  probability.resize(0);
  if (!seen.valid) return false;
  const NeuralNetwork::Values few = clamping_vector(seen);
  NeuralNetwork::Values clamps, leg, body;
  if (!settings_.clamping->evaluate(few, clamps) || !settings_.chain->evaluate(few, leg) ||
      !settings_.body->evaluate(feature_vector(seen), body))
    return false;
  probability.resize(classes_.count());
  probability.head(classes_.bodies()) = clamps(0, 0) * body.col(0);
  probability.tail(classes_.legs()) = clamps(1, 0) * leg.col(0);
  return true;
}

void PapersClassifier::classify(Time now, const ContactPhase& contact, const ContactFeatures& seen,
                                const ContactClassification& last, ContactClassification& result) const {
  result = contact.active && !contact.begins(now) ? last : ContactClassification();
  if (!contact.active || result.valid || !ask(seen, result.probability)) return;
  if (WrenchUncertainty().size(space_, seen.wrench_in_base) < settings_.least_wrench) {
    result.probability.resize(0);
    return;
  }
  result.acquired = seen.acquired;
  result.valid = true;
  Eigen::Index most_likely = 0;
  result.probability.maxCoeff(&most_likely);
  result.most_likely = static_cast<int>(most_likely);
  result.accepted = result.confidence() >= settings_.accept;
}

}  // namespace flinch
