#pragma once

#include <memory>

#include "systems/contact/touch_hypotheses.h"
#include "systems/contact/wrench_uncertainty.h"
#include "systems/framework/system.h"
#include "systems/signals/contact_phase.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// Weighs what may have been touched (`TouchHypotheses`) by the estimated wrench, at every tick of the first
/// `window` of a contact; at others it costs nothing and the last evidence stands.
class EvidenceEstimator final : public System {
 public:
  EvidenceEstimator(std::shared_ptr<const ParallelRobot> robot, const TouchHypothesesSettings& settings,
                    const WrenchUncertainty& uncertainty, Time window);

  InputPort<ContactPhase> phase = input<ContactPhase>("phase");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<WrenchEstimate> wrench = input<WrenchEstimate>("wrench");

 private:
  Intermediate<bool> active_ = intermediate<&EvidenceEstimator::is_active>("active", clock, phase);

 public:
  OutputPort<ContactEvidence> evidence =
      output<&EvidenceEstimator::weigh>(When(active_), "evidence", phase, kinematics, wrench);

 private:
  bool is_active(Time now, const ContactPhase& contact) const {
    return contact.active && now - contact.since <= window_;
  }
  void weigh(const ContactPhase& contact, const Kinematics& now, const WrenchEstimate& estimate,
             ContactEvidence& result) const;

  ConfigurationSpace space_;
  TouchHypotheses hypotheses_;
  WrenchUncertainty uncertainty_;
  Time window_;
};

}  // namespace flinch
