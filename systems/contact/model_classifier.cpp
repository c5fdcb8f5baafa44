#include "systems/contact/model_classifier.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/alike_links.h"

namespace flinch {

ModelClassifier::ModelClassifier(const std::shared_ptr<const ParallelRobot>& robot,
                                 const ModelClassifierSettings& settings)
    : classes_(robot->body_count(), robot->legs()), alike_(legs_of_alike_links(*robot)), settings_(settings) {
  Findings found("model classifier: ");
  found.require(settings.accept > 0.0 && settings.accept <= 1.0, "accept must be above 0 and at most 1");
  found.require(settings.window >= Time{}, "window must not be negative");
  found.positive("independent_ticks", settings.independent_ticks);
  found.positive("largest_residual", settings.largest_residual);
  throw_if_any(found.take());
}

void ModelClassifier::conclude(const ContactEvidence& seen, Memory& next) const {
  ContactClassification& result = next.last;
  const ClassVector mean = next.log_evidence / next.weight * settings_.independent_ticks;
  result.acquired = seen.acquired;
  result.valid = true;
  result.probability = (mean.array() - mean.maxCoeff()).max(-700.0).exp();
  result.probability /= result.probability.sum();
  for (int leg = 0; leg < classes_.legs(); ++leg) {
    if (!alike_[static_cast<std::size_t>(leg)]) continue;
    double& of_second = result.probability[ContactClasses::collision(BodyId::link2(leg))];
    result.probability[ContactClasses::collision(BodyId::link1(leg))] += std::exchange(of_second, 0.0);
  }
  Eigen::Index most_likely = 0;
  result.probability.maxCoeff(&most_likely);
  result.most_likely = static_cast<int>(most_likely);
  result.residual = next.residual / next.weight;
  result.several_contacts = result.residual > settings_.largest_residual;
  result.accepted = result.confidence() >= settings_.accept && !result.several_contacts;
}

void ModelClassifier::advance(Time now, const ContactPhase& contact, const ContactEvidence& seen,
                              const Memory& memory, Memory& next) const {
  if (!contact.active || contact.begins(now)) {
    next = Memory();
    next.log_evidence.setZero(classes_.count());
  } else {
    next = memory;
  }
  const bool adds = contact.active && now - contact.since <= settings_.window && seen.valid &&
                    seen.log_evidence.size() == classes_.count() &&
                    next.log_evidence.size() == classes_.count();
  if (!adds) return;
  Eigen::Index strongest = 0;
  seen.log_evidence.maxCoeff(&strongest);
  const double weight = std::max(seen.force[strongest] * seen.force[strongest], 1.0);
  next.log_evidence += weight * seen.log_evidence;
  next.residual += weight * seen.residual.minCoeff();
  next.weight += weight;
  conclude(seen, next);
}

}  // namespace flinch
