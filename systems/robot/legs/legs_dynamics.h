#pragma once

#include "systems/robot/legs/legs_motion.h"

namespace flinch {

/// Rate over which the step of Coulomb friction is rounded [rad/s or m/s].
constexpr double legs_friction_velocity = 0.01;

/// M dv + C v + g + F_fr of a robot of legs in platform coordinates, as in Dynamics.
struct LegsDynamics {
  PlatformMatrix M;
  PlatformMatrix C;
  PlatformVector g;
  PlatformVector F_fr;

  void set(const LegsModel& model, const LegsMotion& motion) noexcept;

 private:
  void add_platform(const LegsModel& model, const PlatformTwist& platform) noexcept;
  void add_leg(const LegsModel& model, const ModelLeg& leg, const LegMotion& motion) noexcept;
};

}  // namespace flinch
