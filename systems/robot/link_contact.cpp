#include "systems/robot/link_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

/// Unit vectors: `axis` and what is across it.
CartesianJacobian axes_along(const CartesianVector& axis) {
  CartesianJacobian axes(axis.size(), axis.size());
  if (axis.size() == 2) {
    axes << axis[0], -axis[1], axis[1], axis[0];
    return axes;
  }
  const Eigen::Vector3d along = axis;
  const Eigen::Vector3d across = along.unitOrthogonal();
  axes << along, across, along.cross(across);
  return axes;
}

/// Variance of a number that may be anything between 0 and 1.
constexpr double uniform_variance = 1.0 / 12.0;

/// What fits best where the place cannot be known: a push on the middle.
LinkPush in_the_middle(const PlatformVector& g, const PlatformVector& wrench,
                       const Eigen::LLT<PlatformMatrix>& S) {
  LinkPush push;
  const PlatformVector weighted = S.solve(g);
  const double information = weighted.dot(g);
  if (!(information > 0.0)) return push;
  push.valid = true;
  push.force = weighted.dot(wrench) / information;
  // The force times the fraction is what is known.
  const double spread = push.force / push.fraction;
  push.covariance(0, 0) = uniform_variance;
  push.covariance(1, 1) = 1.0 / information + spread * spread * uniform_variance;
  push.covariance(0, 1) = push.covariance(1, 0) = -spread * uniform_variance;
  const PlatformVector missed = wrench - g * push.force;
  push.residual = missed.dot(S.solve(missed));
  return push;
}

/// From the covariance of (f_y, l f_y) that of (l, f_y).
Eigen::Matrix2d of_place_and_force(const Eigen::Matrix2d& C, double fraction, double force) {
  Eigen::Matrix2d change;
  change << -fraction / force, 1.0 / force, 1.0, 0.0;
  return change * C * change.transpose();
}

/// Of (f_y, l f_y), for wrenches g0 f_y + g1 (l f_y); h0 and h1 are S^-1 g0 and S^-1 g1. None where these can
/// hardly be told apart.
std::optional<Eigen::Matrix2d> lever_covariance(const PlatformVector& g0, const PlatformVector& g1,
                                                const PlatformVector& h0, const PlatformVector& h1) {
  constexpr double least_share_apart = 1e-9;  // of g0 that g1 does not explain: what rounding leaves is less
  Eigen::Matrix2d information;
  information << h0.dot(g0), h0.dot(g1), h1.dot(g0), h1.dot(g1);
  const double determinant = information.determinant();
  if (!(determinant > least_share_apart * information(0, 0) * information(1, 1))) return std::nullopt;
  return information.inverse();
}

/// Both numbers of a push as they follow from the wrench; not valid where they do not.
LinkPush unconfined_push(const PlatformVector& g0, const PlatformVector& g1, const PlatformVector& wrench,
                         const Eigen::LLT<PlatformMatrix>& S) {
  const PlatformVector h0 = S.solve(g0);
  const PlatformVector h1 = S.solve(g1);
  const auto levers = lever_covariance(g0, g1, h0, h1);
  if (!levers) return {};
  const Eigen::Matrix2d& C = *levers;
  const Eigen::Vector2d best = C * Eigen::Vector2d(h0.dot(wrench), h1.dot(wrench));
  const double force = best[0];
  if (std::abs(force) <= std::sqrt(C(0, 0))) return {};  // its sign is not known: the ratio means nothing
  LinkPush push{.valid = true, .identifiable = true, .fraction = best[1] / force, .force = force};
  push.covariance = of_place_and_force(C, push.fraction, force);
  const PlatformVector missed = wrench - g0 * best[0] - g1 * best[1];
  push.residual = missed.dot(S.solve(missed));
  return push;
}

bool can_be_a_link(const LinkContactMap& link, const PlatformVector& wrench) {
  return link.valid && link.axes.cols() == 2 && usable(wrench, static_cast<int>(link.along.rows()));
}

/// Where it is known, and on the link as far as that goes.
bool is_identified(const LinkPush& push, double largest_deviation) {
  constexpr double outside = 3.0;
  const double deviation = std::sqrt(push.covariance(0, 0));
  const bool inside = push.fraction >= -outside * deviation && push.fraction <= 1.0 + outside * deviation;
  return push.valid && deviation <= largest_deviation && inside;
}

}  // namespace

LinkContactMap link_contact_map(const Mechanism& robot, const Kinematics& kinematics, BodyId link) noexcept {
  LinkContactMap map;
  if (link.is_platform() || link.index() < 0 || link.index() >= robot.body_count()) return map;
  const CartesianVector begin = robot.axis_point(link, 0.0);
  const CartesianVector end = robot.axis_point(link, 1.0);
  const ContactJacobian at_begin = robot.contact_jacobian(kinematics, link, begin);
  const ContactJacobian at_end = robot.contact_jacobian(kinematics, link, end);
  map.length = (end - begin).norm();
  if (!at_begin.valid || !at_end.valid || map.length <= 0.0) return map;
  map.valid = true;
  for (const Shape& shape : robot.body(link).shapes) {
    if (const auto* capsule = std::get_if<Capsule>(&shape)) map.radius = capsule->radius;
  }
  map.proximal_joint = robot.point_on_body(kinematics, link, begin);
  map.axes = axes_along((robot.point_on_body(kinematics, link, end) - map.proximal_joint) / map.length);
  map.at_joint = at_begin.translation.transpose() * map.axes;
  map.along = at_end.translation.transpose() * map.axes - map.at_joint;
  return map;
}

Lean lean_by_friction(const LinkContactMap& link, const PlatformVector& velocity, double fraction,
                      const CartesianVector& force, double leaning, double object_speed) noexcept {
  const double across = force.tail(force.size() - 1).norm();
  if (leaning <= 0.0 || !link.valid || !(across > 0.0)) return {0.0, leaning};
  // In the axes of the link: of the axis at the fraction, and how much it differs from one end to the other.
  const CartesianVector at_axis = (link.at_joint + fraction * link.along).transpose() * velocity;
  const CartesianVector of_length = link.along.transpose() * velocity;
  const auto to_surface = -link.radius / across * force.tail(force.size() - 1);
  const double sliding = at_axis[0] - of_length.tail(force.size() - 1).dot(to_surface) / link.length;
  const double sign = std::erf(sliding / (std::numbers::sqrt2 * object_speed));  // expected
  const double size = leaning * std::sqrt(2.0 * std::numbers::inv_pi);           // of a half-normal lean
  const double mean = -sign * size;
  return {mean, std::sqrt(leaning * leaning - mean * mean)};
}

LinkPush link_push(const LinkContactMap& link, const PlatformVector& wrench, const PlatformMatrix& covariance,
                   double largest_deviation, double lean) noexcept {
  if (!can_be_a_link(link, wrench)) return {};
  const Eigen::LLT<PlatformMatrix> S(covariance);
  if (S.info() != Eigen::Success) return {};
  const auto leaning_to = [&](double side) {
    const CartesianVector direction = Eigen::Vector2d(side * lean, 1.0);
    return unconfined_push(link.at_joint * direction, link.along * direction, wrench, S);
  };
  LinkPush push = leaning_to(1.0);
  if (lean != 0.0 && (!push.valid || push.force < 0.0)) push = leaning_to(-1.0);
  return is_identified(push, largest_deviation)
             ? push
             : in_the_middle(link.at_joint.col(1) + 0.5 * link.along.col(1), wrench, S);
}

Eigen::Matrix2d lean_covariance(const LinkContactMap& link, const PlatformVector& wrench,
                                const PlatformMatrix& covariance, const LinkPush& push,
                                const Lean& lean) noexcept {
  struct Node {
    double place, weight;
  };
  constexpr double near = 1.3556261799742659, far = 2.8569700138728057;  // the fifth is 0, the push itself
  constexpr Node nodes[] = {{-far, 0.011257411327720689},
                            {-near, 0.22207592200561264},
                            {near, 0.22207592200561264},
                            {far, 0.011257411327720689}};
  Eigen::Matrix2d found = Eigen::Matrix2d::Zero();
  if (lean.deviation <= 0.0) return found;
  const Eigen::LLT<PlatformMatrix> S(covariance);
  const double side = push.force < 0.0 ? -1.0 : 1.0;
  for (const Node& node : nodes) {
    const CartesianVector direction = Eigen::Vector2d(side * (lean.mean + node.place * lean.deviation), 1.0);
    const LinkPush leans = unconfined_push(link.at_joint * direction, link.along * direction, wrench, S);
    if (!leans.valid) return Eigen::Vector2d(1.0, push.force * push.force).asDiagonal();
    const double moved = std::clamp(leans.fraction, 0.0, 1.0) - std::clamp(push.fraction, 0.0, 1.0);
    const Eigen::Vector2d off(moved, leans.force - push.force);
    found += node.weight * off * off.transpose();
  }
  return found;
}

Eigen::Matrix2d push_covariance(const LinkContactMap& link, double fraction, const CartesianVector& force,
                                const PlatformMatrix& covariance) noexcept {
  const Eigen::Matrix2d nothing = Eigen::Matrix2d::Zero();
  if (!link.valid || force.size() != link.axes.cols()) return nothing;
  const double across = link.axes.cols() == 2 ? force[1] : force.tail(force.size() - 1).norm();
  const Eigen::LLT<PlatformMatrix> S(covariance);
  if (!std::isnormal(across) || S.info() != Eigen::Success) return nothing;
  const PlatformVector g0 = link.at_joint * force / across;
  const PlatformVector g1 = link.along * force / across;
  const PlatformVector h0 = S.solve(g0);
  const PlatformVector h1 = S.solve(g1);
  Eigen::Matrix2d found = nothing;
  if (const auto C = lever_covariance(g0, g1, h0, h1)) found = of_place_and_force(*C, fraction, across);
  return found(0, 0) > uniform_variance ? Eigen::Matrix2d(found * (uniform_variance / found(0, 0))) : found;
}

}  // namespace flinch
