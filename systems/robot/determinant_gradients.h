#pragma once

#include "systems/robot/vectors.h"

namespace flinch {

/// How the determinants of the constraints change with the pose: d ln |det A| / dx and d ln |det B| / dx.
struct DeterminantGradients {
  PlatformVector log_A;
  PlatformVector log_B;
};

}  // namespace flinch
