#pragma once

#include "systems/robot/vectors.h"

namespace flinch {

/// How near the robot is to what it must stay away from, at the measured pose.
struct WorkspaceMeasures {
  bool valid = false;         ///< the pose is known and within reach
  double sigma_kappa = 0.0;   ///< condition number of J_x,qa, infinite at a singularity. [SafePR] IV-F
  double sigma_sc = 0.0;      ///< distance between links of different legs [m]. [SafePR] IV-F
  double platform_gap = 0.0;  ///< of links beside the platform, infinite without; not recorded [m]
  double det_A = 0.0;         ///< 0 at a type-II singularity
  double det_B = 0.0;         ///< 0 at a type-I singularity
  double largest_passive_angle = 0.0;  ///< of all legs, without sign [rad]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("sigma_kappa", "", self.sigma_kappa);
    visit("sigma_sc", "m", self.sigma_sc);
    visit("det_A", "", self.det_A);
    visit("det_B", "", self.det_B);
    visit("largest_passive_angle", "rad", self.largest_passive_angle);
  }
};

}  // namespace flinch
