#pragma once

#include <Eigen/Core>
#include <array>

#include "plant/obstacle.h"
#include "systems/framework/time.h"

namespace flinch {

/// Where the obstacles really are.
struct ObstacleTruth {
  Time acquired{};
  bool valid = false;
  /// Of each from its position at rest, in their order [m]; zero beyond the last.
  std::array<Eigen::Vector3d, max_obstacles> displacement_in_base = none();

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("displacement_in_base", "m", self.displacement_in_base, "base");
  }

 private:
  static std::array<Eigen::Vector3d, max_obstacles> none() {
    std::array<Eigen::Vector3d, max_obstacles> displacements;
    displacements.fill(Eigen::Vector3d::Zero());
    return displacements;
  }
};

}  // namespace flinch
