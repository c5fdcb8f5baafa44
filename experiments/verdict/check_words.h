#pragma once

#include <string>
#include <vector>

#include "systems/signals/plausibility.h"

namespace flinch {

/// The checks that are off where none but `askable` can be asked, one sentence each: what is not compared,
/// which fault would follow, and what that needs. `drives_checked`: before the first motion.
std::vector<std::string> checks_off(CheckMask askable, bool drives_checked);

}  // namespace flinch
