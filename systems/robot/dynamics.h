#pragma once

#include "systems/robot/vectors.h"

namespace flinch {

/// Equations of motion in platform coordinates, [SafePR] (4):
///   M_x ddx + C_x dx + g_x + F_fr_x = F_a + F_ext.
/// dM_x/dt = C_x + C_x^T for every velocity. C_x itself is not unique; C_x v and C_x^T v are, and only these
/// and congruences of C_x may be used. Wrenches have the units of the mechanism's space.
struct Dynamics {
  PlatformMatrix M_x;
  PlatformMatrix C_x;
  PlatformVector g_x;     ///< Gravity wrench that the drives must hold.
  PlatformVector F_fr_x;  ///< Friction of active and passive joints.
  bool valid = false;     ///< The pose was reachable and all entries are finite. Otherwise they are zero.
};

/// Gives all of `out` its size for `dof` coordinates and makes it invalid and zero.
void set_invalid(int dof, Dynamics& out) noexcept;

}  // namespace flinch
