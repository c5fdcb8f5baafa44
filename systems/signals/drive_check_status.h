#pragma once

#include <cstdint>

#include "systems/robot/vectors.h"

namespace flinch {

/// How the drives answered small torques before the first motion.
struct DriveCheckStatus {
  enum class Phase : std::uint8_t {
    unwanted,  ///< nobody checks them
    waiting,   ///< until the robot is held at rest by its laws
    running,   ///< a drive is being tried
    passed,    ///< all drives move the robot as their torques should
    failed,    ///< the latest one does not
  };
  Phase phase = Phase::unwanted;
  int drive = -1;  ///< that is being tried or was tried last, from 0; -1: none yet
  /// Motion of each drive that was tried, over what its torque should make; 1: as the model says, 0: none,
  /// -1: the other way; not a number: not yet tried to the end.
  JointVector gain;

  /// Whether the nominal motion has to wait.
  bool holds_motion() const { return phase != Phase::unwanted && phase != Phase::passed; }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("phase", "", self.phase);
    visit("drive", "", self.drive);
    visit("gain", "", self.gain);
  }
};

}  // namespace flinch
