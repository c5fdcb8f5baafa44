#pragma once

#include "systems/robot/body_id.h"
#include "systems/robot/contact_jacobian.h"
#include "systems/robot/kinematics.h"

/// Points fixed to a planar robot with legs of two links: to its platform, whose pose is (x, y, phi) with
/// n = 3 or (x, y) with n = 2, or to a link. [ICRA23] (4)-(6), [SafePR] (3)
namespace flinch {

template <int n>
CartesianVector planar_point_on_body(const Kinematics& kinematics, int legs, BodyId body,
                                     const CartesianVector& point_in_body) noexcept;

template <int n>
ContactJacobian planar_contact_jacobian(const Kinematics& kinematics, int legs, BodyId body,
                                        const CartesianVector& point_in_body) noexcept;

}  // namespace flinch
