#pragma once

#include <Eigen/Core>

namespace flinch {

/// Particles of a contact on a link, as far as they are shown: of each the place on the link and the force
/// across it.
struct ParticleCloud {
  static constexpr int most = 64;

  int body = -1;  ///< BodyId::index(); -1: there are none
  int count = 0;
  Eigen::Matrix<double, 1, most> fraction = Eigen::Matrix<double, 1, most>::Zero();  ///< 0 to 1 of the axis
  Eigen::Matrix<double, 1, most> force = Eigen::Matrix<double, 1, most>::Zero();     ///< [N]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("body", "", self.body);
    visit("count", "", self.count);
    visit("fraction", "1", self.fraction);
    visit("force", "N", self.force);
  }
};

}  // namespace flinch
