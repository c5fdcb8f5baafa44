#include "systems/robot/planar_kinematics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

// Beyond this, inverting J_qa_x leaves less than ten digits.
constexpr double largest_condition_number = 1e6;

// Largest singular value of J: the largest eigenvalue of J^T J is q + 2 p cos(acos(r) / 3), which loses no
// digits.
double norm(const Eigen::Matrix3d& J) {
  Eigen::Matrix3d S = J.transpose() * J;
  const double q = S.trace() / 3.0;
  S.diagonal().array() -= q;
  const double p = std::sqrt(S.squaredNorm() / 6.0);
  const double r = p > 0.0 ? 0.5 * S.determinant() / (p * p * p) : 1.0;
  return std::sqrt(q + 2.0 * p * std::cos(std::acos(std::clamp(r, -1.0, 1.0)) / 3.0));
}

// cond_2 of J, and of its inverse; infinite if J is singular to working precision.
double condition_number(const Eigen::Matrix3d& J, const Eigen::Matrix3d& inverse) {
  const double condition = norm(J) * norm(inverse);
  return condition < 1e8 ? condition : std::numeric_limits<double>::infinity();
}

void set_points(const PlanarMotion& motion, std::array<LegPoints, max_dof>& out) {
  for (std::size_t i = 0; i < 3; ++i) {
    const PlanarLeg& leg = motion.legs[i].leg;
    out[i] = {leg.base_joint, leg.passive_joint, leg.coupling_joint};
  }
}

void set_points_and_rates(const PlanarMotion& motion, Kinematics& out) {
  out.rates.active.resize(3);
  out.rates.passive.resize(3);
  out.rates.coupling.resize(3);
  for (int i = 0; i < 3; ++i) {
    const PlanarLegMotion& leg = motion.legs[static_cast<std::size_t>(i)];
    out.rates.active[i] = leg.qa_rate;
    out.rates.passive[i] = leg.theta2_rate - leg.qa_rate;
    out.rates.coupling[i] = motion.velocity.z() - leg.theta2_rate;
  }
  set_points(motion, out.legs);
}

// delta_red,i = |c_i - elbow_i|^2 - l2^2: rows 2 l2 [e^T, d x e] by pose and -2 l1 l2 sin qp by drive angle.
template <class Out>
void set_determinants(const std::array<PlanarLegGeometry, 3>& geometry, const PlanarMotion& motion,
                      const Eigen::Matrix3d& J_qa, Out& out) {
  out.det_B = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    out.det_B *= -2.0 * geometry[i].link1_length * geometry[i].link2_length * motion.legs[i].leg.sin_qp;
  }
  out.det_A = -out.det_B * J_qa.determinant();  // A = -B J_qa
}

}  // namespace

Eigen::Matrix3d stacked_rows(const PlanarMotion& motion, Eigen::RowVector3d PlanarLegMotion::*row) noexcept {
  Eigen::Matrix3d rows;
  rows << motion.legs[0].*row, motion.legs[1].*row, motion.legs[2].*row;
  return rows;
}

// Norms that are never less than those of the condition number, without its trigonometry, mostly suffice.
bool is_regular(const Eigen::Matrix3d& J, const Eigen::Matrix3d& inverse) noexcept {
  return J.norm() * inverse.norm() < largest_condition_number ||
         condition_number(J, inverse) < largest_condition_number;
}

void differential_kinematics(const std::array<PlanarLegGeometry, 3>& geometry, const PlanarMotion& motion,
                             Kinematics& out) noexcept {
  const Eigen::Matrix3d J_qa = stacked_rows(motion, &PlanarLegMotion::J_qa);
  const Eigen::Matrix3d J_theta2 = stacked_rows(motion, &PlanarLegMotion::J_theta2);
  Eigen::Matrix3d dJ_qa;
  Eigen::Matrix3d dJ_theta2;
  for (int i = 0; i < 3; ++i) {
    const auto leg = static_cast<std::size_t>(i);
    const PlanarLegJacobianRate rate =
        leg_jacobian_rate(geometry[leg], motion.legs[leg], motion.velocity.z());
    dJ_qa.row(i) = rate.dJ_qa;
    dJ_theta2.row(i) = rate.dJ_theta2;
  }

  out.pose = motion.pose;
  out.velocity = motion.velocity;
  set_points_and_rates(motion, out);
  out.J_qa_x = J_qa;
  out.J_qp_x = J_theta2 - J_qa;
  out.J_qc_x = -J_theta2;
  out.J_qc_x.col(2).array() += 1.0;
  out.dJ_qa_x = dJ_qa;
  out.dJ_qp_x = dJ_theta2 - dJ_qa;
  out.dJ_qc_x = -dJ_theta2;

  set_determinants(geometry, motion, J_qa, out);
  const Eigen::Matrix3d inverse = J_qa.inverse();
  out.sigma_kappa = condition_number(J_qa, inverse);
  out.reachable = true;
  out.valid = out.sigma_kappa < largest_condition_number;
  const Eigen::Matrix3d J_x = out.valid ? inverse : Eigen::Matrix3d::Zero();
  out.J_x_qa = J_x;
  out.dJ_x_qa = -J_x * dJ_qa * J_x;
}

void place_kinematics(const std::array<PlanarLegGeometry, 3>& geometry, const PlanarMotion& motion,
                      PlaceKinematics& out) noexcept {
  const Eigen::Matrix3d J_qa = stacked_rows(motion, &PlanarLegMotion::J_qa);
  set_points(motion, out.legs);
  set_determinants(geometry, motion, J_qa, out);
  out.J_qa_x = J_qa;
  out.sigma_kappa = condition_number(J_qa, J_qa.inverse());
  out.valid = out.sigma_kappa < largest_condition_number;
}

}  // namespace flinch
