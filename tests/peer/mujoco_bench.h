#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>

#include "systems/robot/planar_rrr_parameters.h"

namespace flinch::peer {

/// The planar 3-RRR in MuJoCo: three serial legs, a platform that slides and turns freely in the plane, and
/// three `connect` constraints that close the legs on it. Coordinates: (x, y, phi), then (q_a, q_p) of each
/// leg.
class MujocoBench {
 public:
  /// `link1` and `link2` are the bodies of every leg. Joint friction is viscous only. Throws on an XML error.
  MujocoBench(const PlanarRrrParameters& robot, const LinkBody& link1, const LinkBody& link2);

  /// Sets a closed pose and the velocity of all joints that goes with it.
  void set_state(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity,
                 const std::array<double, 3>& active, const std::array<double, 3>& passive,
                 const std::array<double, 3>& active_rate, const std::array<double, 3>& passive_rate);

  /// Platform acceleration under drive torques, by MuJoCo's own constraint solver. MuJoCo lets a constraint's
  /// reference acceleration be -b J v - k r, without the term -dJ/dt v that keeps moving legs closed; it is
  /// put in here, from differences of MuJoCo's own Jacobian.
  Eigen::Vector3d platform_acceleration(const Eigen::Vector3d& drive_torques);

  mjModel* model() { return model_.get(); }
  mjData* data() { return data_.get(); }

  /// The description as MuJoCo's XML.
  const std::string& xml() const { return xml_; }

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  Eigen::MatrixXd constraint_jacobian(mjData* data) const;
  Eigen::VectorXd jacobian_rate_times_velocity() const;

  std::string xml_;
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
  std::unique_ptr<mjData, Delete> probe_;
};

}  // namespace flinch::peer
