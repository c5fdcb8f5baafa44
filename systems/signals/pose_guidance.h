#pragma once

#include "systems/robot/configuration_space.h"
#include "systems/signals/platform_reference.h"

namespace flinch {

/// A reference as seen from where the platform is. What it says of rotation is carried over from the
/// reference's orientation to the platform's, so that error and velocities fit together on every space:
/// where e moves, de/dt is made of v_r - v alone.
struct PoseGuidance {
  PlatformVector error;         ///< e = x_d (-) x
  PlatformVector velocity;      ///< v_r; without rotation in space that of the reference
  PlatformVector acceleration;  ///< dv_r/dt
};

/// Of a valid reference and a platform at `pose` that moves with `velocity`.
PoseGuidance guide(const ConfigurationSpace& space, const PlatformReference& desired,
                   const Configuration& pose, const PlatformVector& velocity) noexcept;

/// The wrench with which a spring pulls the platform towards the reference: that along which the potential
/// e^T K e / 2 falls, so that its power is -(v_r - v)^T wrench. `K_e` is K e. Where the platform turns about
/// three axes its moment is J_l(e_r)^-1 K_r e_r, otherwise it is K e itself. |e_r| must be below 2 pi.
PlatformVector spring_wrench(const ConfigurationSpace& space, const PlatformVector& error,
                             const PlatformVector& K_e) noexcept;

}  // namespace flinch
