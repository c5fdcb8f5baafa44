#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Drive angles with their estimated rates, one entry per leg.
struct JointMotion {
  Time acquired{};
  bool valid = false;
  JointVector position;  ///< q_a [rad]
  JointVector velocity;  ///< its filtered derivative [rad/s]

  /// Whether every drive is known to be slower than `speed` [rad/s or m/s].
  bool rests(double speed) const {
    return valid && velocity.size() > 0 && (velocity.array().abs() < speed).all();
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("position", "<drive position>", self.position);
    visit("velocity", "<drive velocity>", self.velocity);
  }
};

}  // namespace flinch
