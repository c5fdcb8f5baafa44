#pragma once

#include <Eigen/Core>

#include "systems/robot/mechanism.h"

namespace flinch {

/// What the platform feels of a force f on the axis of a link, l of its length from the proximal joint:
///   F = (at_joint + l along) f.
/// Forces count along the axis, which is the first column of `axes`, and across it.
struct LinkContactMap {
  bool valid = false;              ///< The body is a link, with an axis, of a robot that reaches its pose.
  double length = 0.0;             ///< of the axis [m]
  double radius = 0.0;             ///< of the link about its axis [m]
  CartesianVector proximal_joint;  ///< in the base frame [m]
  CartesianJacobian axes;          ///< columns: the axes in which forces count, in the base frame
  PlatformMatrix at_joint;         ///< n x directions
  PlatformMatrix along;            ///< n x directions

  /// The point at a fraction of the axis, in the base frame [m].
  CartesianVector point(double fraction) const { return proximal_joint + fraction * length * axes.col(0); }
};

/// The map of `link`, whose first capsule is its outline, in this pose. [SafePR] (6a), (22)
LinkContactMap link_contact_map(const Mechanism& robot, const Kinematics& kinematics, BodyId link) noexcept;

/// A push across a link, found from a platform wrench.
struct LinkPush {
  bool valid = false;  ///< The wrench could be read so at all. Otherwise nothing below means anything.
  /// Where and how hard follow from the wrench. Otherwise fraction is the middle, as uncertain as a uniform
  /// distribution, and force is what fits best there.
  bool identifiable = false;
  double fraction = 0.5;  ///< l, 0 at the proximal and 1 at the distal joint; not confined to these
  double force = 0.0;     ///< f_y, across the link [N]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of (fraction, force), from that of the wrench
  double residual = 0.0;                                 ///< e^T S^-1 e of what it leaves of the wrench
};

/// How far a force on a link leans along its axis, f_x / |f_y|: normally distributed.
struct Lean {
  double mean = 0.0;
  double deviation = 0.0;
};

/// The lean that friction makes, against the sliding: |f_x / f_y| is half-normal with the root mean square
/// `leaning`. What slides is the touched point, with its velocity along the link, on an object whose own one
/// is normally distributed with the deviation `object_speed` [m/s]. Of a link that hardly moves along itself
/// the sign is not known, and the mean is 0. `velocity`: of the platform; `fraction` and `force`, in the
/// link's axes: of the push. (Derived.)
Lean lean_by_friction(const LinkContactMap& link, const PlatformVector& velocity, double fraction,
                      const CartesianVector& force, double leaning, double object_speed) noexcept;

/// The push f_y across a planar link that explains `wrench` best, in closed form: F = g0 f_y + g1 (l f_y) is
/// linear in f_y and l f_y, so that these are a weighted mean and l is their ratio. Of a 3-RRR this is
///   f_y = F_n + F_e tan qp,  l = F_n / f_y
/// with F_n across and F_e along the second link, where the wrench acts through the coupling joint as that of
/// a leg does. Not identifiable where the wrench does not tell g0 from g1 (a first link, an elbow at 90
/// degrees), where the fraction's standard deviation exceeds `largest_deviation`, or where it lies outside of
/// the link by more than three of them. `covariance`: of the wrench. `lean`: of the force, known.
LinkPush link_push(const LinkContactMap& link, const PlatformVector& wrench, const PlatformMatrix& covariance,
                   double largest_deviation, double lean = 0.0) noexcept;

/// What a force that leans as `lean` says adds to the covariance of a `push` that `link_push` has identified
/// with its mean: the mean square by which the pushes that explain `wrench` then differ from it, by
/// Gauss-Hermite quadrature in five points. A place is on the link. A lean by which nothing explains the
/// wrench counts as the whole link and all of the force. (Derived.)
Eigen::Matrix2d lean_covariance(const LinkContactMap& link, const PlatformVector& wrench,
                                const PlatformMatrix& covariance, const LinkPush& push,
                                const Lean& lean) noexcept;

/// What errors of the wrench with this `covariance` make of place and size of a `force`, in the link's axes,
/// that is found at `fraction`: the covariance of (fraction, force across the link). Not more of the fraction
/// than of one that is anywhere on the link. Zero for maps and forces that cannot be used.
Eigen::Matrix2d push_covariance(const LinkContactMap& link, double fraction, const CartesianVector& force,
                                const PlatformMatrix& covariance) noexcept;

}  // namespace flinch
