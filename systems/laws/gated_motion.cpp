#include "systems/laws/gated_motion.h"

namespace flinch {

bool keeps_limits_in(ReactionMode mode, SafetyFilterSettings::Use use) noexcept {
  switch (mode) {
    case ReactionMode::nominal:
      return use == SafetyFilterSettings::Use::always;
    case ReactionMode::react:
    case ReactionMode::hold:
    case ReactionMode::zero_g:
      return use != SafetyFilterSettings::Use::never;
    case ReactionMode::stopped:
    case ReactionMode::recover:
      break;
  }
  return false;
}

}  // namespace flinch
