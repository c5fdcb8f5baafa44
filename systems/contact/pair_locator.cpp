#include "systems/contact/pair_locator.h"

#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {

PairLocator::PairLocator(const std::shared_ptr<const ParallelRobot>& robot,
                         std::shared_ptr<const LegBases> bases, const TouchPairsSettings& settings,
                         const WrenchUncertainty& uncertainty, Time period)
    : space_(robot->space()),
      pairs_(robot, std::move(bases), settings),
      uncertainty_(uncertainty),
      period_(period) {
  if (period <= Time::zero()) throw SetupError("base forces: the period must be positive");
}

void PairLocator::locate(const ContactPhase& contact, const Kinematics& at, const WrenchEstimate& estimate,
                         const BaseForceEstimate& felt, LocatedContacts& out) const {
  out = LocatedContacts();
  if (!contact.active || !estimate.valid) return;
  const PlatformVector& wrench = estimate.wrench_in_base;
  pairs_.find(at, wrench, uncertainty_.covariance(space_, at, wrench), felt, out);
  out.acquired = estimate.acquired;
}

}  // namespace flinch
