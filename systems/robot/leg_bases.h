#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "systems/robot/body_id.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/mechanism.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Forces at the base joints, leg by leg, in the base frame [N]: what the base does to each leg.
using BaseForces = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * max_dof, 1>;

/// A force on a point of a body, base frame.
struct ForceOnBody {
  int body = -1;  ///< BodyId::index()
  CartesianVector point_in_base;
  CartesianVector force_in_base;
};

/// What a robot's base joints bear, as an extension of its equations of motion: the base of each leg is let
/// move by b while the platform stays, and stands still. With y the leg's coordinates and Y = dy/db,
/// where f acts on a point of that leg, which follows the coupling joint by Lambda and its base by the rest.
/// A force on the platform or on another leg leaves no trace in it. (Derived; [SafePR] VI (ii) asks for it.)
class LegBases {
 public:
  virtual ~LegBases() = default;

  virtual int legs() const noexcept = 0;
  virtual int directions() const noexcept = 0;  ///< of each force
  int size() const noexcept { return legs() * directions(); }

  /// p_b [Ns] and s_b [N] of reachable kinematics under drive torques.
  virtual void momentum(const Kinematics& at, const JointVector& torque, BaseForces& p,
                        BaseForces& s) const noexcept = 0;

  /// (I - Lambda)^T f of the leg of `body` that `force` acts on; zero for the platform.
  virtual CartesianVector felt(const Kinematics& at, BodyId body, const CartesianVector& point_in_base,
                               const CartesianVector& force_in_base) const noexcept = 0;

  /// f_base by Newton and Euler, link by link, of a robot that accelerates by `acceleration` under `torque`
  /// on its first links and these forces.
  virtual void forces(const Kinematics& at, const PlatformVector& acceleration, const JointVector& torque,
                      std::span<const ForceOnBody> contacts, BaseForces& out) const noexcept = 0;
};

/// The base joints of `robot`, whose legs have these first moments, m1 s1 + m2 l1 [kg m], as `believed` has
/// them: legs that are heavier by a share have as much more. Throws SetupError for robots that have no model
/// of their base joints, and for other numbers of moments.
std::shared_ptr<const LegBases> leg_bases(const std::shared_ptr<const Mechanism>& robot,
                                          const JointVector& first_moments, const Mechanism& believed);

}  // namespace flinch
