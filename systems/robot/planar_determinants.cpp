#include "systems/robot/planar_determinants.h"

#include <cmath>
#include <cstddef>

namespace flinch {

// d ln |det A| = sum over i of (d row_i) A^-1 e_i, and A^-1 e_i is J_x,qa e_i to the factor by which rows of
// A and of J_qa,x differ: 1 / (l1 sin q_p).
DeterminantGradients planar_determinant_gradients(const PlanarRrr& robot,
                                                  const Kinematics& kinematics) noexcept {
  Eigen::Vector3d log_A = Eigen::Vector3d::Zero(), log_B = Eigen::Vector3d::Zero();
  const Eigen::Vector2d origin = kinematics.pose.head<2>();
  for (int i = 0; i < robot.legs(); ++i) {
    const PlanarRrrLeg& leg = robot.parameters().legs[static_cast<std::size_t>(i)];
    const LegPoints& points = kinematics.legs[static_cast<std::size_t>(i)];
    const Eigen::Vector2d coupling = points.coupling_joint.head<2>();
    const Eigen::Vector2d e = (coupling - points.passive_joint.head<2>()) / leg.link2_length;
    const Eigen::Vector2d d = coupling - origin;
    const Eigen::Vector3d qp_by_x = kinematics.J_qp_x.row(i).transpose().head<3>();
    const Eigen::Vector3d theta2_by_x = qp_by_x + kinematics.J_qa_x.row(i).transpose().head<3>();
    const Eigen::Vector3d column = kinematics.J_x_qa.col(i).head<3>();
    const double sine = std::sin(kinematics.joints.passive[i]);
    // e turns with theta2, and d with phi.
    const double by_theta2 = -e.y() * column.x() + e.x() * column.y() + d.dot(e) * column.z();
    log_A += by_theta2 / (leg.link1_length * sine) * theta2_by_x;
    log_A.z() -= d.dot(e) * column.z() / (leg.link1_length * sine);
    log_B += std::cos(kinematics.joints.passive[i]) / sine * qp_by_x;
  }
  return {log_A, log_B};
}

}  // namespace flinch
