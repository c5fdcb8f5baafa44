#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "systems/robot/planar_rrr_parameters.h"
#include "tests/peer/mujoco_model.h"

namespace flinch::peer {

/// The planar 3-RRR in MuJoCo: three serial legs, a platform that slides and turns freely in the plane, and
/// three `connect` constraints that close the legs on it. Coordinates: (x, y, phi), then (q_a, q_p) of each
/// leg.
class MujocoRig {
 public:
  /// `link1` and `link2` are the bodies of every leg. Joint friction is viscous only. Throws on an XML error.
  MujocoRig(const PlanarRrrParameters& robot, const LinkBody& link1, const LinkBody& link2);

  /// Sets a closed pose and the velocity of all joints that goes with it.
  void set_state(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity,
                 const std::array<double, 3>& active, const std::array<double, 3>& passive,
                 const std::array<double, 3>& active_rate, const std::array<double, 3>& passive_rate);

  /// Platform acceleration under drive torques, by MuJoCo's own constraint solver.
  Eigen::Vector3d platform_acceleration(const Eigen::Vector3d& drive_torques);

  mjModel* model() { return mujoco_.model(); }
  mjData* data() { return mujoco_.data(); }

  /// The description as MuJoCo's XML.
  const std::string& xml() const { return xml_; }

 private:
  std::string xml_;
  MujocoModel mujoco_;
};

}  // namespace flinch::peer
