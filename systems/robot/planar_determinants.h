#pragma once

#include "systems/robot/planar_rrr.h"

namespace flinch {

/// The gradients of a planar 3-RRR in closed form, where `kinematics` is valid.
///
/// The rows of A are [e_i, d_i x e_i] to factors that do not change, e_i along the second link and d_i from
/// the platform to the coupling joint, and det B is a product of sin(q_p,i), likewise.
DeterminantGradients planar_determinant_gradients(const PlanarRrr& robot,
                                                  const Kinematics& kinematics) noexcept;

}  // namespace flinch
