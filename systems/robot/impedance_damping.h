#pragma once

#include "systems/robot/vectors.h"

namespace flinch {

enum class DampingDesign {
  factorisation,           ///< [SafePR] (9)
  generalised_eigenvalue,  ///< Fallback: exact damping of each mode, always positive definite.
  none                     ///< The inputs admit no damping: not finite, or M not positive definite.
};

/// Damping matrix of an impedance, and how it was obtained. Zero for `none`.
struct ImpedanceDamping {
  PlatformMatrix D;
  DampingDesign design = DampingDesign::none;
};

/// Damping of M dde + D de + K e = f with damping ratios `xi` (1 = critical) for a symmetric positive
/// definite inertia M and a symmetric positive semi-definite stiffness K. Where the factorisation D = sqrt(M)
/// Xi sqrt(K) + sqrt(K) Xi sqrt(M) is not positive definite, falls back to D = M W diag(2 xi_i
/// sqrt(lambda_i)) W^T M with K w = lambda M w, W^T M W = I (lambda ascending). The fallback is only
/// semi-definite if K is.
ImpedanceDamping impedance_damping(const PlatformMatrix& M, const PlatformMatrix& K,
                                   const PlatformVector& xi) noexcept;

/// The factorisation alone, [SafePR] (9): symmetric, but not positive definite in general.
PlatformMatrix factorisation_damping(const PlatformMatrix& M, const PlatformMatrix& K,
                                     const PlatformVector& xi) noexcept;

/// The generalised-eigenvalue design alone.
PlatformMatrix modal_damping(const PlatformMatrix& M, const PlatformMatrix& K,
                             const PlatformVector& xi) noexcept;

}  // namespace flinch
