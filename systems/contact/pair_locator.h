#pragma once

#include <memory>

#include "systems/contact/touch_pairs.h"
#include "systems/framework/system.h"
#include "systems/signals/contact_phase.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// Locates one or two contacts by wrench and base forces (`TouchPairs`), from the detection of a contact on
/// and anew after each `period`; in between the last answer stands, and it costs nothing.
class PairLocator final : public System {
 public:
  PairLocator(const std::shared_ptr<const ParallelRobot>& robot, std::shared_ptr<const LegBases> bases,
              const TouchPairsSettings& settings, const WrenchUncertainty& uncertainty, Time period);

  InputPort<ContactPhase> phase = input<ContactPhase>("phase");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<WrenchEstimate> wrench = input<WrenchEstimate>("wrench");
  InputPort<BaseForceEstimate> bases = input<BaseForceEstimate>("bases");

 private:
  Intermediate<bool> due_ = intermediate<&PairLocator::is_due>("due", clock, phase);

 public:
  OutputPort<LocatedContacts> contacts =
      output<&PairLocator::locate>(When(due_), "contacts", phase, kinematics, wrench, bases);

 private:
  /// Also at the tick at which a contact is over, so that nothing is told from then on.
  bool is_due(Time now, const ContactPhase& contact) const {
    return !contact.active || (now - contact.since) % period_ == Time::zero();
  }
  void locate(const ContactPhase& contact, const Kinematics& at, const WrenchEstimate& estimate,
              const BaseForceEstimate& felt, LocatedContacts& out) const;

  ConfigurationSpace space_;
  TouchPairs pairs_;
  WrenchUncertainty uncertainty_;
  Time period_;
};

}  // namespace flinch
