#include "tests/peer/mujoco_legs.h"

#include <algorithm>
#include <array>

#include "convert/mjcf_text.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/rotation.h"

namespace flinch::peer {
namespace {

constexpr int steps_from_home = 10;
constexpr int most_iterations = 30;
constexpr double closed = 1e-12;  // what is left of a loop [m, rad]

}  // namespace

MujocoLegs::MujocoLegs(const LegsParameters& parameters)
    : robot_(parameters), mujoco_(mjcf_text(parameters)) {
  mjModel* model = mujoco_.model();
  model->opt.disableflags |= mjDSBL_LIMIT;
  model->opt.jacobian = mjJAC_DENSE;
  model->opt.solver = mjSOL_NEWTON;
  model->opt.tolerance = 1e-14;
  model->opt.iterations = 200;
  for (int i = 0; i < model->neq; ++i) {  // as hard as it can be
    std::copy_n(std::array<mjtNum, mjNIMP>{0.9999, 0.9999, 0.001, 0.5, 2.0}.data(), mjNIMP,
                model->eq_solimp + i * mjNIMP);
    std::copy_n(std::array<mjtNum, mjNREF>{0.004, 1.0}.data(), mjNREF, model->eq_solref + i * mjNREF);
  }
}

Eigen::MatrixXd MujocoLegs::to_own_axes(const Configuration& pose) const {
  Eigen::MatrixXd turn = Eigen::MatrixXd::Identity(robot_.dof(), robot_.dof());
  if (robot_.space().rotations() == 3)
    turn.bottomRightCorner<3, 3>() = rotation_matrix(pose.tail<4>()).transpose();
  return turn;
}

Eigen::MatrixXd MujocoLegs::constraint_jacobian() {
  const mjModel* model = mujoco_.model();
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(mujoco_.data()->efc_J, mujoco_.data()->nefc, model->nv);
}

void MujocoLegs::set_platform(const Configuration& pose) {
  mjtNum* position = mujoco_.data()->qpos;
  if (mujoco_.model()->jnt_type[0] == mjJNT_FREE) {  // an orientation that follows is for close() to find
    std::copy(pose.begin(), pose.end(), position);
  } else {  // slides and hinges, zero at home
    const PlatformVector from_home = robot_.space().difference(pose, robot_.home_pose());
    std::copy(from_home.begin(), from_home.end(), position);
  }
}

bool MujocoLegs::close(const Configuration& pose) {
  mjModel* model = mujoco_.model();
  mjData* data = mujoco_.data();
  set_platform(pose);
  const Eigen::Index joints = model->nv - robot_.dof();
  Eigen::VectorXd move = Eigen::VectorXd::Zero(model->nv);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    mj_fwdPosition(model, data);
    const Eigen::Map<const Eigen::VectorXd> open(data->efc_pos, data->nefc);
    if (open.lpNorm<Eigen::Infinity>() < closed) return true;
    move.tail(joints) =
        -constraint_jacobian().rightCols(joints).completeOrthogonalDecomposition().solve(open);
    mj_integratePos(model, data->qpos, move.data(), 1.0);
  }
  return false;
}

void MujocoLegs::set_rates(const Configuration& pose, const PlatformVector& velocity) {
  const mjModel* model = mujoco_.model();
  const Eigen::Index dof = robot_.dof(), joints = model->nv - dof;
  Eigen::Map<Eigen::VectorXd> rates(mujoco_.data()->qvel, model->nv);
  const Eigen::MatrixXd J = constraint_jacobian();
  rates.head(dof) = to_own_axes(pose) * velocity;
  rates.tail(joints) =
      -J.rightCols(joints).completeOrthogonalDecomposition().solve(J.leftCols(dof) * rates.head(dof));
}

std::optional<PlatformVector> MujocoLegs::platform_acceleration(const Configuration& pose,
                                                                const PlatformVector& velocity,
                                                                const JointVector& efforts) {
  mj_resetData(mujoco_.model(), mujoco_.data());
  const PlatformVector way = robot_.space().difference(pose, robot_.home_pose());
  for (int step = 1; step <= steps_from_home; ++step) {
    const double share = static_cast<double>(step) / steps_from_home;
    if (!close(robot_.space().plus(robot_.home_pose(), share * way))) return std::nullopt;
  }
  set_rates(pose, velocity);
  std::copy(efforts.begin(), efforts.end(), mujoco_.data()->ctrl);
  const Eigen::VectorXd accelerations = mujoco_.acceleration();
  return PlatformVector(to_own_axes(pose).transpose() * accelerations.head(robot_.dof()));
}

}  // namespace flinch::peer
