#pragma once

#include <array>
#include <memory>

#include "systems/robot/leg_bases.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {

/// The base joints of a planar 3-RRR, each leg with the coordinates (b, theta1, theta2), its links' absolute
/// angles. Besides the base parameters they need the first moment of each leg, m1 s1 + m2 l1 [kg m].
class PlanarLegBases final : public LegBases {
 public:
  PlanarLegBases(std::shared_ptr<const PlanarRrr> robot, const std::array<double, 3>& first_moments);

  int legs() const noexcept override { return 3; }
  int directions() const noexcept override { return 2; }
  void momentum(const Kinematics& at, const JointVector& torque, BaseForces& p,
                BaseForces& s) const noexcept override;
  CartesianVector felt(const Kinematics& at, BodyId body, const CartesianVector& point_in_base,
                       const CartesianVector& force_in_base) const noexcept override;
  void forces(const Kinematics& at, const PlatformVector& acceleration, const JointVector& torque,
              std::span<const ForceOnBody> contacts, BaseForces& out) const noexcept override;

 private:
  std::shared_ptr<const PlanarRrr> robot_;
  std::array<double, 3> first_moments_;
};

}  // namespace flinch
