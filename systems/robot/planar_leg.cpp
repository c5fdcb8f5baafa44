#include "systems/robot/planar_leg.h"

#include <cmath>

namespace flinch {

PlanarLegGeometry leg_geometry(const PlanarLegParameters& leg, const Eigen::Vector2d& base_joint,
                               const Eigen::Vector2d& coupling_in_platform) noexcept {
  return {.base_joint = base_joint,
          .base_angle = leg.base_angle,
          .base_direction = unit_vector(leg.base_angle),
          .coupling_in_platform = coupling_in_platform,
          .link1_length = leg.link1_length,
          .link2_length = leg.link2_length};
}

PlanarLeg close_leg(const PlanarLegGeometry& geometry, const Eigen::Vector2d& origin,
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
  const double along = (reach_squared + l1 * l1 - l2 * l2) / (2.0 * reach_squared);
  const double across_squared = l1 * l1 / reach_squared - along * along;
  // Far away the first condition is lost in rounding.
  leg.reachable = across_squared > 0.0 && across_squared < HUGE_VAL && reach_squared < (l1 + l2) * (l1 + l2);
  if (!leg.reachable) return leg;

  const double across = elbow_sign * std::sqrt(across_squared);
  const Eigen::Vector2d elbow_from_base = along * w - across * normal(w);
  leg.passive_joint = leg.base_joint + elbow_from_base;
  leg.u1 = elbow_from_base / l1;
  leg.u2 = (w - elbow_from_base) / l2;
  leg.sin_qp = across * reach_squared / (l1 * l2);
  leg.cos_qp = (reach_squared - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
  return leg;
}

double active_angle(const PlanarLegGeometry& geometry, const PlanarLeg& leg) noexcept {
  const Eigen::Vector2d& from = geometry.base_direction;
  return std::atan2(cross(from, leg.u1), from.dot(leg.u1));
}

double passive_angle(const PlanarLeg& leg) noexcept { return std::atan2(leg.sin_qp, leg.cos_qp); }

Eigen::Vector2d chain_tip(const PlanarLegGeometry& geometry, double active, double passive) noexcept {
  const double theta1 = geometry.base_angle + active;
  return geometry.base_joint + geometry.link1_length * unit_vector(theta1) +
         geometry.link2_length * unit_vector(theta1 + passive);
}

PlanarLegMotion leg_motion(const PlanarLegGeometry& geometry, const PlanarLeg& leg,
                           const Eigen::Vector3d& velocity) noexcept {
  const double lever1 = 1.0 / (geometry.link1_length * leg.sin_qp);
  const double lever2 = -1.0 / (geometry.link2_length * leg.sin_qp);

  PlanarLegMotion motion;
  motion.leg = leg;
  motion.J_qa << lever1 * leg.u2.x(), lever1 * leg.u2.y(), lever1 * cross(leg.arm, leg.u2);
  motion.J_theta2 << lever2 * leg.u1.x(), lever2 * leg.u1.y(), lever2 * cross(leg.arm, leg.u1);
  motion.qa_rate = motion.J_qa.dot(velocity);
  motion.theta2_rate = motion.J_theta2.dot(velocity);
  return motion;
}

PlanarLegJacobianRate leg_jacobian_rate(const PlanarLegGeometry& geometry, const PlanarLegMotion& motion,
                                        double phi_rate) noexcept {
  const PlanarLeg& leg = motion.leg;
  const double lever1 = 1.0 / (geometry.link1_length * leg.sin_qp);
  const double lever2 = -1.0 / (geometry.link2_length * leg.sin_qp);
  const double lever_rate = leg.cos_qp / leg.sin_qp * (motion.theta2_rate - motion.qa_rate);
  const double qa_rate = motion.qa_rate;
  const double theta2_rate = motion.theta2_rate;
  const Eigen::Vector2d n1 = normal(leg.u1);
  const Eigen::Vector2d n2 = normal(leg.u2);

  PlanarLegJacobianRate rate;
  rate.dJ_qa << lever1 * theta2_rate * n2.x(), lever1 * theta2_rate * n2.y(),
      lever1 * (theta2_rate - phi_rate) * leg.arm.dot(leg.u2);
  rate.dJ_theta2 << lever2 * qa_rate * n1.x(), lever2 * qa_rate * n1.y(),
      lever2 * (qa_rate - phi_rate) * leg.arm.dot(leg.u1);
  rate.dJ_qa -= lever_rate * motion.J_qa;
  rate.dJ_theta2 -= lever_rate * motion.J_theta2;
  return rate;
}

}  // namespace flinch
