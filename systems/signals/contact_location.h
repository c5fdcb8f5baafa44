#pragma once

#include <Eigen/Core>

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Where on a body and how hard a single contact pushes, if it is that body.
struct ContactLocation {
  Time acquired{};        ///< of the readings that it tells of
  bool valid = false;     ///< There is something to locate. Otherwise nothing below means anything.
  bool located = false;   ///< Point and force follow from the wrench as well as the deviations say. Otherwise
                          ///< they are the nearest guess, or nothing where they are empty.
  int body = -1;          ///< BodyId::index() of the body that was assumed
  double fraction = 0.0;  ///< of the axis of a link, from its proximal joint on; 0 for the platform
  CartesianVector point_in_base;  ///< on the outline of the body [m]
  CartesianVector force_in_base;  ///< on the robot [N]
  double point_deviation = 0.0;   ///< standard deviation along the link or on the platform's outline [m]
  double force_deviation = 0.0;   ///< of the force's size [N]
  /// Of (fraction, force across the link [N]), links only.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  /// e^T S^-1 e of what the contact leaves of the wrench, e, S being the covariance that its noise is told to
  /// have. Of a place in closed form that is confined to its link: as before that.
  double residual = 0.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("located", "", self.located);
    visit("body", "", self.body);
    visit("fraction", "1", self.fraction);
    visit("point_in_base", "m", self.point_in_base, "base");
    visit("force_in_base", "N", self.force_in_base, "base");
    visit("point_deviation", "m", self.point_deviation);
    visit("force_deviation", "N", self.force_deviation);
    visit("covariance", "1, N", self.covariance);
    visit("residual", "1", self.residual);
  }
};

}  // namespace flinch
