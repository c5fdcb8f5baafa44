#include "systems/robot/legs/legs_dynamics.h"

namespace flinch {
namespace {

using Square =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_leg_coordinates, max_leg_coordinates>;

/// In the coordinates of one leg.
struct OfLeg {
  Square M, C;
  LegCoordinates g, friction;

  explicit OfLeg(int k) : M(Square::Zero(k, k)), C(Square::Zero(k, k)) {
    g.setZero(k);
    friction.setZero(k);
  }
};

// M += m J_v^T J_v + J_w^T I J_w, C += m J_v^T dJ_v + J_w^T (I dJ_w + S(omega) I J_w), g -= m J_v^T gravity,
// J_v at the centre of mass.
void add_link(const LegsModel& model, const LegChain& chain, const LegMotion& motion, std::size_t joint,
              OfLeg& sum) {
  const RigidBodyInertia& link = chain.joints[joint].link;
  const ChainPlace& place = motion.place;
  const Eigen::Matrix3d& R = place.axes[joint];
  const Eigen::Vector3d& omega = motion.rates.omega[joint];
  const Eigen::Vector3d arm = R * link.centre_of_mass;
  PointColumns columns;
  chain.columns(place, motion.rates, joint, place.origin[joint] + arm,
                motion.rates.velocity[joint] + omega.cross(arm), columns);
  const Eigen::Matrix3d I = R * link.inertia * R.transpose();
  const auto k = static_cast<std::size_t>(chain.coordinates);
  std::array<Eigen::Vector3d, static_cast<std::size_t>(max_leg_coordinates)> momentum, momentum_rate;
  for (std::size_t i = 0; i < k; ++i) {
    momentum[i].noalias() = I * columns.w[i];
    momentum_rate[i] = I * columns.dw[i] + omega.cross(momentum[i]);
  }
  for (std::size_t i = 0; i < k; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    sum.g[row] -= link.mass * columns.v[i].dot(model.gravity);
    for (std::size_t j = 0; j < k; ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      sum.C(row, column) += link.mass * columns.v[i].dot(columns.dv[j]) + columns.w[i].dot(momentum_rate[j]);
      if (j > i) continue;
      const double entry = link.mass * columns.v[i].dot(columns.v[j]) + columns.w[i].dot(momentum[j]);
      sum.M(row, column) += entry;
      if (j < i) sum.M(column, row) += entry;
    }
  }
}

void add_joint(const ChainJoint& joint, const LegCoordinates& s_rate, OfLeg& sum) {
  const int i = joint.coordinate;
  sum.M(i, i) += joint.ratio * joint.ratio * joint.armature;
  const double rate = joint.ratio * s_rate[i];
  sum.friction[i] += joint.ratio * friction_effort(joint.friction, rate, legs_friction_velocity);
}

}  // namespace

void LegsDynamics::set(const LegsModel& model, const LegsMotion& motion) noexcept {
  const Eigen::Index n = motion.platform.T.cols();
  M.setZero(n, n);
  C.setZero(n, n);
  g.setZero(n);
  F_fr.setZero(n);
  add_platform(model, motion.platform);
  for (std::size_t i = 0; i < model.legs.size(); ++i) add_leg(model, model.legs[i], motion.legs[i]);
}

// As a link, with the columns J_v = T_t - S(R c) T_w and J_w = T_w.
void LegsDynamics::add_platform(const LegsModel& model, const PlatformTwist& platform) noexcept {
  const double m = model.platform.mass;
  const Eigen::Matrix3d& R = platform.axes;
  const Eigen::Vector3d omega = platform.omega();
  const Eigen::Vector3d arm = R * model.platform.centre_of_mass;
  const Eigen::Vector3d arm_rate = omega.cross(arm);
  const Eigen::Matrix3d I = R * model.platform.inertia * R.transpose();
  std::array<Eigen::Vector3d, static_cast<std::size_t>(max_dof)> v, w, dv, momentum, momentum_rate;
  const auto n = static_cast<std::size_t>(M.rows());
  for (std::size_t i = 0; i < n; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    w[i] = platform.T.col(column).tail<3>();
    v[i] = platform.T.col(column).head<3>() + w[i].cross(arm);
    const Eigen::Vector3d dw = platform.dT.col(column).tail<3>();
    dv[i] = platform.dT.col(column).head<3>() + dw.cross(arm) + w[i].cross(arm_rate);
    momentum[i] = I * w[i];
    momentum_rate[i] = I * dw + omega.cross(momentum[i]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    g[row] -= m * v[i].dot(model.gravity);
    for (std::size_t j = 0; j < n; ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      M(row, column) += m * v[i].dot(v[j]) + w[i].dot(momentum[j]);
      C(row, column) += m * v[i].dot(dv[j]) + w[i].dot(momentum_rate[j]);
    }
  }
}

// M += G^T M_l G, C += G^T (M_l dG + C_l G), g += G^T g_l.
void LegsDynamics::add_leg(const LegsModel& model, const ModelLeg& leg, const LegMotion& motion) noexcept {
  OfLeg sum(leg.chain.coordinates);
  for (std::size_t j = 0; j < leg.chain.joints.size(); ++j) {
    if (leg.chain.joints[j].link.mass > 0.0) add_link(model, leg.chain, motion, j, sum);
    add_joint(leg.chain.joints[j], motion.s_rate, sum);
  }
  const CoordinateMap& G = motion.G;
  const CoordinateMap M_G = sum.M.lazyProduct(G);
  CoordinateMap C_G = sum.C.lazyProduct(G);
  C_G += sum.M.lazyProduct(motion.dG);
  M += G.transpose().lazyProduct(M_G);
  C += G.transpose().lazyProduct(C_G);
  g += G.transpose().lazyProduct(sum.g);
  F_fr += G.transpose().lazyProduct(sum.friction);
}

}  // namespace flinch
