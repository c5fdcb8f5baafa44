#pragma once

#include "systems/robot/vectors.h"

namespace flinch {

/// The equations of motion at one instant, as far as an integration of the motion needs them:
///   M_x dv + h_x = J_qa,x^T tau_a + F_ext,  h_x = C_x v + g_x + F_fr,x, all as in Dynamics.
struct MotionEquations {
  PlatformMatrix M_x;
  PlatformVector h_x;
  bool valid = false;  ///< Otherwise they mean nothing.
};

}  // namespace flinch
