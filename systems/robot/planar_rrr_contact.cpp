#include <cmath>
#include <cstddef>

#include "systems/robot/planar_rrr.h"

// Points fixed to the structure. [ICRA23] (4)-(6), [SafePR] (3)
namespace flinch {
namespace {

using Rows2 = Eigen::Matrix<double, 2, 3>;

bool serves(const Kinematics& kinematics, BodyId body, const CartesianVector& point) {
  return kinematics.reachable && drive_count(kinematics) == 3 && point.size() == 2 && point.allFinite() &&
         body.index() >= 0 && body.index() < 7;
}

Eigen::Vector2d platform_axis(const Kinematics& kinematics) {
  return {std::cos(kinematics.pose[2]), std::sin(kinematics.pose[2])};
}

const LegPoints& leg_points(const Kinematics& kinematics, BodyId link) {
  return kinematics.legs[static_cast<std::size_t>(link.leg())];
}

Eigen::Vector2d direction(const CartesianVector& from, const CartesianVector& to) {
  return Eigen::Vector2d((to - from).head<2>()).normalized();
}

// A link's angular velocity row and its derivative.
struct AngularRow {
  Eigen::RowVector3d J;
  Eigen::RowVector3d dJ;
  double rate;
};

AngularRow first_link(const Kinematics& k, int leg) {
  return {k.J_qa_x.row(leg), k.dJ_qa_x.row(leg), k.rates.active[leg]};
}

AngularRow second_link(const Kinematics& k, int leg) {
  return {k.J_qa_x.row(leg) + k.J_qp_x.row(leg), k.dJ_qa_x.row(leg) + k.dJ_qp_x.row(leg),
          k.rates.active[leg] + k.rates.passive[leg]};
}

// Adds the velocity of the end of `arm` relative to its beginning, as the arm turns with `link`.
void add_arm(const Eigen::Vector2d& arm, const AngularRow& link, Rows2& J, Rows2& dJ) {
  J += normal(arm) * link.J;
  dJ += normal(arm) * link.dJ - arm * link.rate * link.J;
}

}  // namespace

CartesianVector PlanarRrr::point_on_body(const Kinematics& kinematics, BodyId body,
                                         const CartesianVector& point_in_body) const noexcept {
  if (!serves(kinematics, body, point_in_body)) return CartesianVector::Zero(2);
  const Eigen::Vector2d point = point_in_body;
  if (body.is_platform()) {
    return Eigen::Vector2d(kinematics.pose.head<2>() + rotate(platform_axis(kinematics), point));
  }
  const LegPoints& leg = leg_points(kinematics, body);
  const CartesianVector& begin = body.is_link1() ? leg.base_joint : leg.passive_joint;
  const CartesianVector& end = body.is_link1() ? leg.passive_joint : leg.coupling_joint;
  return begin + rotate(direction(begin, end), point);
}

ContactJacobian PlanarRrr::contact_jacobian(const Kinematics& kinematics, BodyId body,
                                            const CartesianVector& point_in_body) const noexcept {
  Rows2 J = Rows2::Zero();
  Rows2 dJ = Rows2::Zero();
  AngularRow turning{Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero(), 0.0};
  const bool valid = serves(kinematics, body, point_in_body);

  if (valid && body.is_platform()) {
    turning = {Eigen::RowVector3d::UnitZ(), Eigen::RowVector3d::Zero(), kinematics.velocity[2]};
    J.leftCols<2>().setIdentity();
    add_arm(rotate(platform_axis(kinematics), point_in_body), turning, J, dJ);
  } else if (valid) {
    const LegPoints& leg = leg_points(kinematics, body);
    const Eigen::Vector2d point = point_on_body(kinematics, body, point_in_body);
    const Eigen::Vector2d elbow = leg.passive_joint;
    const Eigen::Vector2d base = leg.base_joint;
    turning = first_link(kinematics, body.leg());
    add_arm((body.is_link1() ? point : elbow) - base, turning, J, dJ);
    if (body.is_link2()) {
      turning = second_link(kinematics, body.leg());
      add_arm(point - elbow, turning, J, dJ);
    }
  }
  return {
      .translation = J, .d_translation = dJ, .rotation = turning.J, .d_rotation = turning.dJ, .valid = valid};
}

}  // namespace flinch
