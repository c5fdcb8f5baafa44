#include "plant/realism.h"

#include <numbers>

#include "systems/robot/mechanism.h"

namespace flinch {

Realism rig_realism(DriveKind drives) {
  Realism realism = kind_realism(drives);
  realism.friction_stiffness = drives == DriveKind::revolute ? 4e4 : 5e6;
  realism.cogging_harmonics = 4;
  return realism;
}

Realism kind_realism(DriveKind drives) {
  constexpr double degree = std::numbers::pi / 180.0;
  return {.friction = 0.2,
          .leg_inertia = 0.03,
          .platform_inertia = 0.03,
          .payload = 0.1,
          .torque_constant = 0.015,
          .cogging = 0.005,
          .torque_ripple = 0.01,
          .current_lag = 0.3e-3,
          .active_encoder_wave = drives == DriveKind::revolute ? 0.0056 * degree : 4e-6,
          .passive_encoder_wave = 0.1 * degree,
          .passive_encoder_offset = 0.1 * degree};
}

}  // namespace flinch
