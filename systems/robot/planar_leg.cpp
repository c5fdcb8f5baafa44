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

PlanarLegJacobianRate leg_jacobian_rate(const PlanarLegGeometry& geometry, const PlanarLegMotion& motion,
                                        double phi_rate) noexcept {
  const PlanarLeg& leg = motion.leg;
  const double per_sine = 1.0 / leg.sin_qp;
  const double lever1 = per_sine / geometry.link1_length;
  const double lever2 = -per_sine / geometry.link2_length;
  const double lever_rate = leg.cos_qp * per_sine * (motion.theta2_rate - motion.qa_rate);
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
