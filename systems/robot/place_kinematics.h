#pragma once

#include <array>
#include <limits>

#include "systems/robot/kinematics.h"

namespace flinch {

/// What of the kinematics the place of a robot determines alone, whatever its velocity, so far as limits of
/// the place are measured by it. All as in Kinematics.
struct PlaceKinematics {
  std::array<LegPoints, max_dof> legs;
  PlatformMatrix J_qa_x;
  double det_A = 0.0;
  double det_B = 0.0;
  double sigma_kappa = std::numeric_limits<double>::infinity();
  bool valid = false;
};

}  // namespace flinch
