#pragma once

#include <cmath>

#include "systems/framework/time.h"

namespace flinch {

/// Standard deviation [s] of a time that lies anywhere in a range of this width, equally likely.
inline double uniform_deviation(Time width) { return to_seconds(width) / std::sqrt(12.0); }

}  // namespace flinch
