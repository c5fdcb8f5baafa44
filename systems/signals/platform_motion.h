#pragma once

#include <cstdint>

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Pose and velocity of the platform as the encoders tell them.
struct PlatformMotion {
  enum class Status : std::uint8_t {
    valid,
    no_data,        ///< the joint reading was not valid
    not_converged,  ///< forward kinematics found no pose
    implausible,    ///< encoders contradict each other, or the pose has jumped to another branch
    singular,       ///< the pose is too near to a singularity to compute a velocity
  };
  Time acquired{};
  Status status = Status::no_data;
  Configuration pose;       ///< x, in the base frame
  PlatformVector velocity;  ///< v

  bool valid() const { return status == Status::valid; }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("status", "", self.status);
    visit("pose", "<pose>", self.pose, "base");
    visit("velocity", "<velocity>", self.velocity, "base");
  }
};

}  // namespace flinch
