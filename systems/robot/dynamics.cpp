#include "systems/robot/dynamics.h"

namespace flinch {

void set_invalid(int dof, Dynamics& out) noexcept {
  out.M_x.setZero(dof, dof);
  out.C_x.setZero(dof, dof);
  out.g_x.setZero(dof);
  out.F_fr_x.setZero(dof);
  out.valid = false;
}

}  // namespace flinch
