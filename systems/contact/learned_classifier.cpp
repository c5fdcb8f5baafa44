#include "systems/contact/learned_classifier.h"

#include <utility>

#include "systems/contact/evidence_features.h"
#include "systems/contact/wrench_uncertainty.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

LearnedClassifier::LearnedClassifier(std::shared_ptr<const ParallelRobot> robot,
                                     LearnedClassifierSettings settings)
    : robot_(std::move(robot)),
      classes_(robot_->body_count(), robot_->legs()),
      settings_(std::move(settings)) {
  Findings found("learned classifier: ");
  found.require(settings_.network != nullptr, "there is no network");
  if (settings_.network) {
    const NetworkParameters& parameters = settings_.network->parameters();
    found.require(
        parameters.inputs() == evidence_feature_count && parameters.result == NetworkResult::softmax_of_rows,
        "the network answers another question than which class was touched");
  }
  found.require(settings_.accept >= 0.0 && settings_.accept <= 1.0, "accept must be between 0 and 1");
  found.not_negative("least_wrench", settings_.least_wrench);
  found.require(settings_.window >= Time{}, "window must not be negative");
  found.positive("largest_residual", settings_.largest_residual);
  found.require(classes_.count() <= NeuralNetwork::max_rows, "the robot has too many bodies to compare");
  throw_if_any(found.take());
}

void LearnedClassifier::classify(Time now, const ContactPhase& contact, const Kinematics& pose,
                                 const ContactEvidence& seen, const ContactEvidence& growth,
                                 const ContactWindow& how, const ContactClassification& last,
                                 ContactClassification& result) const {
  result = contact.active && !contact.begins(now) ? last : ContactClassification();
  const bool is_told = contact.active && now - contact.since <= settings_.window && pose.valid &&
                       seen.valid && growth.valid && how.valid;
  if (!is_told) return;
  const auto courses = leg_histories(*robot_, pose, how.moments);
  if (!courses) return;
  NeuralNetwork::Values features, probability;
  const double force = how.moments.front().wrench_in_base.head(robot_->space().translations()).norm();
  evidence_features(classes_, {seen, growth, *courses, force}, features);
  if (!settings_.network->evaluate(features, probability)) return;
  result.acquired = seen.acquired;
  result.valid = true;
  result.probability = probability.row(0).transpose();
  Eigen::Index most_likely = 0;
  result.probability.maxCoeff(&most_likely);
  result.most_likely = static_cast<int>(most_likely);
  result.residual = seen.residual.minCoeff();
  result.several_contacts = result.residual > settings_.largest_residual;
  const bool is_large =
      WrenchUncertainty().size(robot_->space(), how.moments.front().wrench_in_base) >= settings_.least_wrench;
  result.accepted = result.confidence() >= settings_.accept && is_large && !result.several_contacts;
}

}  // namespace flinch
