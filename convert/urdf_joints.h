#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "systems/robot/legs/legs_assembly.h"
#include "systems/robot/legs/legs_parameters.h"

namespace flinch {

/// Turns about fixed x, y and z, which is about z, y and x of the frame that turns [rad].
Eigen::Vector3d roll_pitch_yaw(const Eigen::Matrix3d& R);

/// The entries of the platform's chart, x, y, z, rx, ry, rz, that are joints of its own in a URDF, in their
/// order from the base. Turns are about z, y and x, one after the other.
std::vector<std::size_t> platform_joint_entries(const PlatformMoves& moves);
/// "platform_x".
std::string platform_joint_name(std::size_t entry);
/// "leg1_elbow"; of a joint with several axes that of one, from 1, "leg1_elbow_2".
std::string leg_joint_name(std::size_t leg, const LegJoint& joint, int axis);

/// All joints that move in the URDF of a robot, and their positions, as the joint states of ROS 2 have them.
class UrdfJoints {
 public:
  /// Throws SetupError with what is wrong with `robot`.
  explicit UrdfJoints(const LegsParameters& robot);

  /// The platform's own, then those of each leg, as they stand in the URDF.
  const std::vector<std::string>& names() const { return names_; }
  /// At home [rad or m].
  const std::vector<double>& at_home() const { return at_home_; }

  /// Sets as many positions where the platform is at a pose. False where the legs do not reach.
  bool find(const Configuration& pose, std::vector<double>& positions) const;

 private:
  void fill(const Eigen::Isometry3d& platform, std::span<const LegCoordinates> legs,
            std::vector<double>& positions) const;

  LegsModel model_;
  std::vector<std::size_t> entries_;
  std::vector<std::string> names_;
  std::vector<double> at_home_;
};

}  // namespace flinch
