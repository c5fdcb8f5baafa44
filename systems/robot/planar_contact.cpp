#include "systems/robot/planar_contact.h"

#include <cmath>
#include <cstddef>

#include "systems/robot/planar_leg.h"

namespace flinch {
namespace {

bool serves(const Kinematics& kinematics, int n, int legs, BodyId body, const CartesianVector& point) {
  return kinematics.reachable && kinematics.pose.size() == n && drive_count(kinematics) == legs &&
         usable(point, 2) && body.index() >= 0 && body.index() <= 2 * legs;
}

template <int n>
Eigen::Vector2d platform_axis(const Kinematics& kinematics) {
  if constexpr (n == 2) return Eigen::Vector2d::UnitX();
  return {std::cos(kinematics.pose[2]), std::sin(kinematics.pose[2])};
}

const LegPoints& leg_points(const Kinematics& kinematics, BodyId link) {
  return kinematics.legs[static_cast<std::size_t>(link.leg())];
}

Eigen::Vector2d direction(const CartesianVector& from, const CartesianVector& to) {
  return Eigen::Vector2d((to - from).head<2>()).normalized();
}

// A body's angular velocity row and its derivative.
template <int n>
struct AngularRow {
  Eigen::Matrix<double, 1, n> J = Eigen::Matrix<double, 1, n>::Zero();
  Eigen::Matrix<double, 1, n> dJ = Eigen::Matrix<double, 1, n>::Zero();
  double rate = 0.0;
};

template <int n>
AngularRow<n> platform(const Kinematics& k) {
  AngularRow<n> row;
  if constexpr (n == 3) {
    row.J[2] = 1.0;
    row.rate = k.velocity[2];
  }
  return row;
}

template <int n>
AngularRow<n> first_link(const Kinematics& k, int leg) {
  return {k.J_qa_x.row(leg), k.dJ_qa_x.row(leg), k.rates.active[leg]};
}

template <int n>
AngularRow<n> second_link(const Kinematics& k, int leg) {
  return {k.J_qa_x.row(leg) + k.J_qp_x.row(leg), k.dJ_qa_x.row(leg) + k.dJ_qp_x.row(leg),
          k.rates.active[leg] + k.rates.passive[leg]};
}

// Velocity map of a point, which `add_arm` moves on by the end of an arm that turns with a body.
template <int n>
struct PointRows {
  Eigen::Matrix<double, 2, n> J = Eigen::Matrix<double, 2, n>::Zero();
  Eigen::Matrix<double, 2, n> dJ = Eigen::Matrix<double, 2, n>::Zero();

  void add_arm(const Eigen::Vector2d& arm, const AngularRow<n>& body) {
    J += normal(arm) * body.J;
    dJ += normal(arm) * body.dJ - arm * body.rate * body.J;
  }
};

}  // namespace

template <int n>
CartesianVector planar_point_on_body(const Kinematics& kinematics, int legs, BodyId body,
                                     const CartesianVector& point_in_body) noexcept {
  if (!serves(kinematics, n, legs, body, point_in_body)) return CartesianVector::Zero(2);
  const Eigen::Vector2d point = point_in_body;
  if (body.is_platform()) {
    return Eigen::Vector2d(kinematics.pose.head<2>() + rotate(platform_axis<n>(kinematics), point));
  }
  const LegPoints& leg = leg_points(kinematics, body);
  const CartesianVector& begin = body.is_link1() ? leg.base_joint : leg.passive_joint;
  const CartesianVector& end = body.is_link1() ? leg.passive_joint : leg.coupling_joint;
  return begin + rotate(direction(begin, end), point);
}

template <int n>
ContactJacobian planar_contact_jacobian(const Kinematics& kinematics, int legs, BodyId body,
                                        const CartesianVector& point_in_body) noexcept {
  PointRows<n> point;
  AngularRow<n> turning;
  const bool valid = serves(kinematics, n, legs, body, point_in_body);

  if (valid && body.is_platform()) {
    turning = platform<n>(kinematics);
    point.J.template leftCols<2>().setIdentity();
    point.add_arm(rotate(platform_axis<n>(kinematics), point_in_body), turning);
  } else if (valid) {
    const LegPoints& leg = leg_points(kinematics, body);
    const Eigen::Vector2d in_base = planar_point_on_body<n>(kinematics, legs, body, point_in_body);
    const Eigen::Vector2d elbow = leg.passive_joint;
    const Eigen::Vector2d base = leg.base_joint;
    turning = first_link<n>(kinematics, body.leg());
    point.add_arm((body.is_link1() ? in_base : elbow) - base, turning);
    if (body.is_link2()) {
      turning = second_link<n>(kinematics, body.leg());
      point.add_arm(in_base - elbow, turning);
    }
  }
  return {.translation = point.J,
          .d_translation = point.dJ,
          .rotation = turning.J,
          .d_rotation = turning.dJ,
          .valid = valid};
}

template CartesianVector planar_point_on_body<2>(const Kinematics&, int, BodyId,
                                                 const CartesianVector&) noexcept;
template CartesianVector planar_point_on_body<3>(const Kinematics&, int, BodyId,
                                                 const CartesianVector&) noexcept;
template ContactJacobian planar_contact_jacobian<2>(const Kinematics&, int, BodyId,
                                                    const CartesianVector&) noexcept;
template ContactJacobian planar_contact_jacobian<3>(const Kinematics&, int, BodyId,
                                                    const CartesianVector&) noexcept;

}  // namespace flinch
