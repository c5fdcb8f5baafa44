#pragma once

#include <string>
#include <vector>

#include "systems/signals/plausibility.h"

namespace flinch {

/// The checks that are off where none but `askable` can be asked, one sentence each: what is not compared,
/// which fault would follow, and what that needs.
std::vector<std::string> checks_off(CheckMask askable);

}  // namespace flinch
