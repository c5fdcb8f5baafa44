#pragma once

#include "systems/robot/vectors.h"

namespace flinch {

/// What of a recorded wrench estimate is looked at, whichever estimator made it.
struct RecordedEstimate {
  bool valid = false;
  PlatformVector wrench_in_base;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("wrench_in_base", "<wrench>", self.wrench_in_base, "base");
  }
};

/// The largest component of a force or moment in size; 0 where it has none.
inline double largest_component(const auto& vector) {
  return vector.size() == 0 ? 0.0 : vector.template lpNorm<Eigen::Infinity>();
}

}  // namespace flinch
