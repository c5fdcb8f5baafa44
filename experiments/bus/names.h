#pragma once

#include "drivers/drive_state.h"
#include "systems/signals/reaction_state.h"

namespace flinch {

/// As people read them; "unknown" for a number that names none.
const char* name(DriveState state);
const char* name(ReactionMode mode);

}  // namespace flinch
