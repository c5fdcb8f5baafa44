#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// What the encoders say at one instant, one entry per leg.
struct JointReading {
  Time acquired{};             ///< when the encoders were latched
  bool valid = false;          ///< the active angles are fresh and finite
  bool passive_valid = false;  ///< so are the passive ones
  JointVector active;          ///< q_a, model zero [rad]
  JointVector passive;         ///< q_p [rad]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("passive_valid", "", self.passive_valid);
    visit("active", "<drive position>", self.active);
    visit("passive", "<passive position>", self.passive);
  }
};

}  // namespace flinch
