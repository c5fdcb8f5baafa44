#pragma once

#include "systems/robot/configuration_space.h"
#include "systems/signals/platform_reference.h"

namespace flinch {

/// The motion x(t) = base (+) xi(t) on the manifold, from xi and its first two derivatives at one instant:
/// pose, velocity and acceleration of the platform. Where xi keeps its direction the rotation has a fixed
/// axis, and what is planned for the length of xi holds for the platform exactly.
PlatformReference chart_motion(const ConfigurationSpace& space, const Configuration& base,
                               const PlatformVector& xi, const PlatformVector& xi_rate,
                               const PlatformVector& xi_acceleration) noexcept;

}  // namespace flinch
