#include "tests/peer/mujoco_model.h"

#include <array>
#include <cstring>
#include <stdexcept>

namespace flinch::peer {
namespace {

mjModel* load(const std::string& xml) {
  // MuJoCo reads XML from files, or from its own virtual file system.
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "robot.xml", static_cast<int>(xml.size()));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  std::array<char, 1000> error{};
  mjModel* model = mj_loadXML("robot.xml", files.get(), error.data(), error.size());
  mj_deleteVFS(files.get());
  if (model == nullptr) throw std::runtime_error(error.data());
  return model;
}

}  // namespace

MujocoModel::MujocoModel(const std::string& xml)
    : model_(load(xml)), data_(mj_makeData(model_.get())), probe_(mj_makeData(model_.get())) {}

Eigen::MatrixXd MujocoModel::constraint_jacobian(mjData* data) const {
  mj_fwdPosition(model_.get(), data);
  Eigen::MatrixXd jacobian(data->nefc, model_->nv);
  if (mj_isSparse(model_.get()) != 0) {
    throw std::runtime_error(
        "the constraint Jacobian is sparse; these robots are small enough for a dense one");
  }
  for (int row = 0; row < data->nefc; ++row) {
    for (int column = 0; column < model_->nv; ++column)
      jacobian(row, column) = data->efc_J[row * model_->nv + column];
  }
  return jacobian;
}

Eigen::MatrixXd MujocoModel::constraint_jacobian_after(double seconds) const {
  std::memcpy(probe_->qpos, data_->qpos, sizeof(mjtNum) * static_cast<std::size_t>(model_->nq));
  mj_integratePos(model_.get(), probe_->qpos, data_->qvel, seconds);
  return constraint_jacobian(probe_.get());
}

Eigen::VectorXd MujocoModel::jacobian_rate_times_velocity() const {
  constexpr double h = 1e-6;
  const Eigen::Map<const Eigen::VectorXd> v(data_->qvel, model_->nv);
  return (constraint_jacobian_after(h) - constraint_jacobian_after(-h)) * v / (2 * h);
}

Eigen::VectorXd MujocoModel::acceleration() {
  mjData* data = data_.get();
  const Eigen::VectorXd drift = jacobian_rate_times_velocity();
  mj_fwdPosition(model_.get(), data);
  mj_fwdVelocity(model_.get(), data);
  mj_fwdActuation(model_.get(), data);
  mj_fwdAcceleration(model_.get(), data);
  for (int row = 0; row < data->nefc; ++row) data->efc_aref[row] -= drift[row];
  mj_fwdConstraint(model_.get(), data);
  return Eigen::Map<const Eigen::VectorXd>(data->qacc, model_->nv);
}

}  // namespace flinch::peer
