#pragma once

#include <optional>

#include "systems/robot/mechanism.h"

namespace flinch {

/// How the determinants of the constraints change with the pose: d ln |det A| / dx and d ln |det B| / dx.
struct DeterminantGradients {
  PlatformVector log_A;
  PlatformVector log_B;
};

/// Those of a planar 3-RRR in closed form. Nothing for other mechanisms, and where `kinematics` is not valid.
///
/// The rows of A are [e_i, d_i x e_i] to factors that do not change, e_i along the second link and d_i from
/// the platform to the coupling joint, and det B is a product of sin(q_p,i), likewise.
std::optional<DeterminantGradients> planar_determinant_gradients(const Mechanism& mechanism,
                                                                 const Kinematics& kinematics) noexcept;

}  // namespace flinch
