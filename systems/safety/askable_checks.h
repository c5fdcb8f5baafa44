#pragma once

#include "systems/signals/plausibility.h"

namespace flinch {

struct PlausibilityMemory;
struct PlausibilityTick;

/// The questions that have what they need: sensors, what was learned of them while the brakes held the robot,
/// commands that reach the robot whose readings are seen. `memory` is that after the tick. Whether a question
/// has anything to ask just now is another matter: in a controlled stop, with closed brakes, while torques
/// act.
CheckMask askable_checks(const PlausibilityMemory& memory, const PlausibilityTick& tick) noexcept;

}  // namespace flinch
