#include "systems/robot/alike_links.h"

#include "systems/robot/contact_jacobian.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/link_segments.h"

namespace flinch {
namespace {

constexpr double alike = 1e-6;  // of wrenches of length 1

/// An orthonormal basis of the wrenches that pushes across a link make.
Eigen::MatrixXd pushes_across(const ParallelRobot& robot, const Kinematics& at, BodyId link) {
  const int directions = robot.space_dimension();
  const CartesianVector begin = robot.point_on_body(at, link, robot.axis_point(link, 0.0));
  const CartesianVector end = robot.point_on_body(at, link, robot.axis_point(link, 1.0));
  const CartesianVector along = (end - begin).normalized();
  Eigen::MatrixXd wrenches(robot.dof(), 0);
  for (const double fraction : {0.3, 0.7}) {
    const ContactJacobian contact = robot.contact_jacobian(at, link, robot.axis_point(link, fraction));
    for (int axis = 0; axis < directions; ++axis) {
      CartesianVector push = CartesianVector::Unit(directions, axis);
      push -= along.dot(push) * along;
      wrenches.conservativeResize(Eigen::NoChange, wrenches.cols() + 1);
      wrenches.rightCols<1>() = platform_wrench(contact, push);
    }
  }
  const double largest = wrenches.colwise().norm().maxCoeff();
  if (!(largest > 0.0)) return Eigen::MatrixXd(robot.dof(), 0);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(wrenches / largest, Eigen::ComputeThinU);
  const auto rank = (svd.singularValues().array() > alike).count();
  return svd.matrixU().leftCols(rank);
}

}  // namespace

std::vector<bool> legs_of_alike_links(const ParallelRobot& robot) {
  Kinematics at;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), at);
  std::vector<bool> legs;
  for (int leg = 0; leg < robot.legs(); ++leg) {
    const Eigen::MatrixXd first = pushes_across(robot, at, BodyId::link1(leg));
    const Eigen::MatrixXd second = pushes_across(robot, at, BodyId::link2(leg));
    legs.push_back(first.cols() > 0 && first.cols() == second.cols() &&
                   (second - first * (first.transpose() * second)).norm() < alike);
  }
  return legs;
}

}  // namespace flinch
