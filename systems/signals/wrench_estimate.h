#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"
#include "systems/signals/estimator_health.h"

namespace flinch {

/// An estimated external wrench: what the surroundings do to the robot, as acting on the platform.
struct WrenchEstimate {
  Time acquired{};                ///< of the readings that it tells of
  bool valid = false;             ///< also false while an observer settles after a reset
  PlatformVector wrench_in_base;  ///< F_ext, moment about the platform origin [N, Nm]
  JointVector drive_torque;       ///< the same seen by the drives, tau_a,ext = J_x,qa^T F_ext [Nm]
  /// Of each component of F_ext, from the noise that the estimator was told of; errors of the model come on
  /// top [N, Nm]. Empty: it was told of none.
  PlatformVector standard_deviation{};
  EstimatorHealth health{};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("wrench_in_base", "<wrench>", self.wrench_in_base, "base");
    visit("drive_torque", "<drive force>", self.drive_torque);
    visit("standard_deviation", "<wrench>", self.standard_deviation, "base");
    visit("health", "", self.health);
  }
};

}  // namespace flinch
