#pragma once

#include <Eigen/Core>
#include <cmath>

#include "systems/robot/planar_leg_parameters.h"

/// One leg of a planar robot: a base joint, a first link, an elbow (the passive joint), a second link, and
/// the coupling joint on the platform. Base frame, m and rad; u1, u2 are the directions of the links, theta1
/// and theta2 their angles, qp = theta2 - theta1, d the arm from the platform origin to the coupling joint.
namespace flinch {

/// Constant geometry of a leg.
struct PlanarLegGeometry {
  Eigen::Vector2d base_joint;            ///< a
  double base_angle = 0.0;               ///< psi, from which the drive angle is measured.
  Eigen::Vector2d base_direction;        ///< u(psi)
  Eigen::Vector2d coupling_in_platform;  ///< r_c u(beta), in frame E.
  double link1_length = 0.0;
  double link2_length = 0.0;
};

/// A leg closed at a pose of the platform.
struct PlanarLeg {
  Eigen::Vector2d base_joint, passive_joint, coupling_joint;
  Eigen::Vector2d arm;     ///< d
  Eigen::Vector2d u1, u2;  ///< Unit vectors along the links, towards the platform.
  double sin_qp = 0.0;
  double cos_qp = 0.0;
  bool reachable = false;  ///< Otherwise no other entry but joints at base and coupling means anything.
};

/// How a leg moves with the platform. Rows map platform velocity (dx, dy, dphi) to joint rates.
struct PlanarLegMotion {
  PlanarLeg leg;
  Eigen::RowVector3d J_qa;      ///< To the rate of the first link, which is the drive's.
  Eigen::RowVector3d J_theta2;  ///< To the absolute rate of the second link.
  double qa_rate = 0.0;         ///< [rad/s]
  double theta2_rate = 0.0;     ///< [rad/s]
};

/// Time derivatives of the rows of PlanarLegMotion.
struct PlanarLegJacobianRate {
  Eigen::RowVector3d dJ_qa;
  Eigen::RowVector3d dJ_theta2;
};

/// Unit vector at `angle`.
inline Eigen::Vector2d unit_vector(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// a x b in the plane.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// v turned by +90 degrees.
inline Eigen::Vector2d normal(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

/// v, given in a frame whose x axis points along the unit vector `axis`, in the frame of `axis`.
inline Eigen::Vector2d rotate(const Eigen::Vector2d& axis, const Eigen::Vector2d& v) {
  return v.x() * axis + v.y() * normal(axis);
}

/// The geometry of `leg`, fixed to the base at `base_joint` and to the platform at `coupling_in_platform`.
PlanarLegGeometry leg_geometry(const PlanarLegParameters& leg, const Eigen::Vector2d& base_joint,
                               const Eigen::Vector2d& coupling_in_platform) noexcept;

/// Closes a leg by intersecting the circles of its two links; `elbow_sign` is the sign of sin qp. The
/// platform has its origin at `origin` and its x axis along the unit vector `axis`.
inline PlanarLeg close_leg(const PlanarLegGeometry& geometry, const Eigen::Vector2d& origin,
                           const Eigen::Vector2d& axis, double elbow_sign) noexcept {
  PlanarLeg leg;
  leg.arm = rotate(axis, geometry.coupling_in_platform);
  leg.base_joint = geometry.base_joint;
  leg.coupling_joint = origin + leg.arm;

  // The elbow is at along * w + across * w_perp, w from base to coupling joint.
  const double l1 = geometry.link1_length;
  const double l2 = geometry.link2_length;
  const Eigen::Vector2d w = leg.coupling_joint - leg.base_joint;
  const double reach_squared = w.squaredNorm();
  const double per_reach = 1.0 / reach_squared;  // divisions are dear
  const double along = 0.5 * (reach_squared + l1 * l1 - l2 * l2) * per_reach;
  const double across_squared = l1 * l1 * per_reach - along * along;
  // Far away the first condition is lost in rounding.
  leg.reachable = across_squared > 0.0 && across_squared < HUGE_VAL && reach_squared < (l1 + l2) * (l1 + l2);
  if (!leg.reachable) return leg;

  const double across = elbow_sign * std::sqrt(across_squared);
  const Eigen::Vector2d elbow_from_base = along * w - across * normal(w);
  leg.passive_joint = leg.base_joint + elbow_from_base;
  const double per_lengths = 1.0 / (l1 * l2);
  leg.u1 = l2 * per_lengths * elbow_from_base;
  leg.u2 = l1 * per_lengths * (w - elbow_from_base);
  leg.sin_qp = across * reach_squared * per_lengths;
  leg.cos_qp = 0.5 * (reach_squared - l1 * l1 - l2 * l2) * per_lengths;
  return leg;
}

/// Angle of the drive of a reachable leg, in (-pi, pi] [rad].
double active_angle(const PlanarLegGeometry& geometry, const PlanarLeg& leg) noexcept;

/// Angle of its elbow, in (-pi, pi] [rad].
double passive_angle(const PlanarLeg& leg) noexcept;

/// Where the leg ends when it is followed from its drive and elbow.
Eigen::Vector2d chain_tip(const PlanarLegGeometry& geometry, double active, double passive) noexcept;

/// Jacobian rows and rates of a reachable leg. [SafePR] (1) in closed form.
inline PlanarLegMotion leg_motion(const PlanarLegGeometry& geometry, const PlanarLeg& leg,
                                  const Eigen::Vector3d& velocity) noexcept {
  const double per_lengths = 1.0 / (geometry.link1_length * geometry.link2_length * leg.sin_qp);
  const double lever1 = geometry.link2_length * per_lengths;
  const double lever2 = -geometry.link1_length * per_lengths;

  PlanarLegMotion motion;
  motion.leg = leg;
  motion.J_qa << lever1 * leg.u2.x(), lever1 * leg.u2.y(), lever1 * cross(leg.arm, leg.u2);
  motion.J_theta2 << lever2 * leg.u1.x(), lever2 * leg.u1.y(), lever2 * cross(leg.arm, leg.u1);
  motion.qa_rate = motion.J_qa.dot(velocity);
  motion.theta2_rate = motion.J_theta2.dot(velocity);
  return motion;
}

/// Time derivatives of the Jacobian rows; `phi_rate` is the platform's [rad/s].
PlanarLegJacobianRate leg_jacobian_rate(const PlanarLegGeometry& geometry, const PlanarLegMotion& motion,
                                        double phi_rate) noexcept;

}  // namespace flinch
