#pragma once

#include "systems/framework/time.h"

namespace flinch {

/// As far as stamps of an IMU may be said to err: beyond, they tell nothing of a contact.
inline constexpr Time largest_stamp_spread = 5ms;

}  // namespace flinch
