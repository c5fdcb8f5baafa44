#pragma once

#include <optional>

#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/motion_equations.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// dv [m/s^2, rad/s^2] of M dv + C v + g + F_fr = A^T tau_a + F_ext at the instant of `kinematics` and
/// `dynamics`, under drive torques or forces tau_a and an external platform wrench. Regular at type-II
/// singularities too. Nothing where either input is invalid, of the wrong size or not finite.
std::optional<PlatformVector> forward_dynamics(const Kinematics& kinematics, const Dynamics& dynamics,
                                               const JointVector& drive_efforts,
                                               const PlatformVector& external_wrench) noexcept;

/// The same of equations that are at hand as such.
std::optional<PlatformVector> forward_dynamics(const Kinematics& kinematics, const MotionEquations& equations,
                                               const JointVector& drive_efforts,
                                               const PlatformVector& external_wrench) noexcept;

/// v^T M v / 2 [J].
double kinetic_energy(const Kinematics& kinematics, const Dynamics& dynamics) noexcept;
double kinetic_energy(const Kinematics& kinematics, const MotionEquations& equations) noexcept;

/// Power that friction takes from the motion [W], never negative.
double friction_power(const Kinematics& kinematics, const Dynamics& dynamics) noexcept;

}  // namespace flinch
