#pragma once

#include <Eigen/Core>

namespace flinch {

/// What the drives do from one tick to the next. The default: no torque, brakes closed.
struct DriveAction {
  Eigen::Vector3d torque{0.0, 0.0, 0.0};   ///< Acting on the drives' axes, without the brakes' [Nm].
  Eigen::Vector3d current{0.0, 0.0, 0.0};  ///< In the motors [A].
  bool enabled = false;                    ///< A command is obeyed.
  bool braked = true;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("torque", "<drive force>", self.torque);
    visit("current", "A", self.current);
    visit("enabled", "", self.enabled);
    visit("braked", "", self.braked);
  }
};

}  // namespace flinch
