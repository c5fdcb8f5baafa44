#include "systems/contact/evidence_estimator.h"

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

WrenchUncertainty checked(const WrenchUncertainty& uncertainty) {
  Findings found("wrench uncertainty: ");
  uncertainty.find_problems(found);
  throw_if_any(found.take());
  return uncertainty;
}

}  // namespace

EvidenceEstimator::EvidenceEstimator(std::shared_ptr<const ParallelRobot> robot,
                                     const TouchHypothesesSettings& settings,
                                     const WrenchUncertainty& uncertainty, Time window)
    : space_(robot->space()),
      hypotheses_(std::move(robot), settings),
      uncertainty_(checked(uncertainty)),
      window_(window) {}

void EvidenceEstimator::weigh(const ContactPhase& contact, const Kinematics& now,
                              const WrenchEstimate& estimate, ContactEvidence& result) const {
  const bool can_be_weighed =
      contact.active && estimate.valid && usable(estimate.wrench_in_base, space_.dimension());
  const PlatformVector F =
      can_be_weighed ? estimate.wrench_in_base : PlatformVector::Zero(space_.dimension());
  hypotheses_.weigh(now, F, uncertainty_.covariance(space_, now, F), result);
  result.valid = result.valid && can_be_weighed;
  result.acquired = estimate.acquired;
}

}  // namespace flinch
