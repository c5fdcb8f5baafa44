#include "systems/laws/kept_motion.h"

namespace flinch {

bool keeps_limits_in(ReactionMode mode, LimitKeeperSettings::Use use) noexcept {
  switch (mode) {
    case ReactionMode::nominal:
      return use == LimitKeeperSettings::Use::always;
    case ReactionMode::react:
    case ReactionMode::hold:
    case ReactionMode::zero_g:
      return use != LimitKeeperSettings::Use::never;
    case ReactionMode::stopped:
    case ReactionMode::recover:
      break;
  }
  return false;
}

}  // namespace flinch
