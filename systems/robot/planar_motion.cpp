#include "systems/robot/planar_motion.h"

#include <cstddef>

namespace flinch {
namespace {

const PlanarLegMotion& leg_of(const PlanarMotion& motion, BodyId link) {
  return motion.legs[static_cast<std::size_t>(link.leg())];
}

}  // namespace

Eigen::Vector2d point_velocity(const PlanarMotion& motion, BodyId body,
                               const Eigen::Vector2d& point) noexcept {
  if (body.is_platform()) {
    return motion.velocity.head<2>() + motion.velocity.z() * normal(point - motion.pose.head<2>());
  }
  const PlanarLegMotion& legs = leg_of(motion, body);
  const PlanarLeg& leg = legs.leg;
  if (body.is_link1()) return legs.qa_rate * normal(point - leg.base_joint);
  return legs.qa_rate * normal(leg.passive_joint - leg.base_joint) +
         legs.theta2_rate * normal(point - leg.passive_joint);
}

// Virtual work: the force's moments about the joints it turns, mapped by those joints' Jacobian rows.
Eigen::Vector3d contact_wrench(const PlanarMotion& motion, BodyId body, const Eigen::Vector2d& point,
                               const Eigen::Vector2d& force) noexcept {
  if (body.is_platform()) return {force.x(), force.y(), cross(point - motion.pose.head<2>(), force)};
  const PlanarLegMotion& legs = leg_of(motion, body);
  const PlanarLeg& leg = legs.leg;
  if (body.is_link1()) return cross(point - leg.base_joint, force) * legs.J_qa.transpose();
  return cross(leg.passive_joint - leg.base_joint, force) * legs.J_qa.transpose() +
         cross(point - leg.passive_joint, force) * legs.J_theta2.transpose();
}

}  // namespace flinch
