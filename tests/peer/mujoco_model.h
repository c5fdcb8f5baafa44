#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>
#include <string>

namespace flinch::peer {

/// A model of MuJoCo with its state. Legs of a parallel robot are closed by `connect` constraints.
class MujocoModel {
 public:
  /// Throws on an error in the XML.
  explicit MujocoModel(const std::string& xml);

  /// Accelerations of all joints at the state of `data`, controls included, by MuJoCo's own constraint
  /// solver. MuJoCo lets a constraint's reference acceleration be -b J v - k r, without the term -dJ/dt v
  /// that keeps moving legs closed; it is put in here, from differences of MuJoCo's own Jacobian.
  Eigen::VectorXd acceleration();

  mjModel* model() { return model_.get(); }
  mjData* data() { return data_.get(); }

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  Eigen::MatrixXd constraint_jacobian(mjData* data) const;
  Eigen::MatrixXd constraint_jacobian_after(double seconds) const;
  Eigen::VectorXd jacobian_rate_times_velocity() const;

  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
  std::unique_ptr<mjData, Delete> probe_;
};

}  // namespace flinch::peer
