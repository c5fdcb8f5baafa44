#include "systems/safety/stopping_motion.h"

#include "systems/safety/fault_table.h"

namespace flinch {

PlatformMotion StoppingMotion::trust(const GateStatus& last, const PlatformMotion& moving,
                                     const FaultReport& found) const {
  const bool stops = last.phase == GatePhase::closed;
  const FaultMask since = found.present | (stops ? last.faults : 0);
  const bool may_stop = last.passes() || last.reaction == GateReaction::controlled_stop;
  const bool is_trusted =
      may_stop && found.valid && since != 0 && (since & ~faults_that_doubt(Doubt::nothing)) == 0;
  return is_trusted ? moving : PlatformMotion();
}

}  // namespace flinch
