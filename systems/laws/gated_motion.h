#pragma once

#include "systems/framework/system.h"
#include "systems/laws/safety_filter.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/reaction_state.h"

namespace flinch {

/// Whether a SafetyFilter that is used so keeps the limits in this mode.
bool keeps_limits_in(ReactionMode mode, SafetyFilterSettings::Use use) noexcept;

/// The platform's motion in the modes in which limits are kept, and otherwise no data.
class GatedMotion final : public System {
 public:
  explicit GatedMotion(SafetyFilterSettings::Use use) : use_(use) {}

  InputPort<PlatformMotion> motion = input<PlatformMotion>("motion");
  InputPort<ReactionState> reaction = input<ReactionState>("reaction");
  OutputPort<PlatformMotion> kept = output<&GatedMotion::keep>("kept", motion, reaction);

 private:
  PlatformMotion keep(const PlatformMotion& moving, const ReactionState& state) const {
    return keeps_limits_in(state.mode, use_) ? moving : PlatformMotion();
  }

  SafetyFilterSettings::Use use_;
};

}  // namespace flinch
