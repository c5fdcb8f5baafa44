#include "convert/urdf_joints.h"

#include <cmath>
#include <utility>

#include "convert/platform_at_home.h"
#include "convert/xml_tag.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

Eigen::Vector3d roll_pitch_yaw(const Eigen::Matrix3d& R) {
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  if (std::hypot(R(0, 0), R(1, 0)) < 1e-9) return {0.0, pitch, std::atan2(-R(0, 1), R(1, 1))};
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

std::vector<std::size_t> platform_joint_entries(const PlatformMoves& moves) {
  const auto is_moved = [&](std::size_t i) { return moves.roles[i] != ChartRole::fixed; };
  const bool turns_in_space = is_moved(3) || is_moved(4);
  std::vector<std::size_t> entries;
  for (const std::size_t i : {0U, 1U, 2U, 5U, 4U, 3U}) {
    if (is_moved(i) || (i >= 3 && turns_in_space)) entries.push_back(i);
  }
  return entries;
}

std::string platform_joint_name(std::size_t entry) { return "platform_" + std::string(chart_names[entry]); }

std::string leg_joint_name(std::size_t leg, const LegJoint& joint, int axis) {
  const std::string name = name_in_model(leg, joint.name);
  return axis_count(joint.kind) > 1 ? name + "_" + std::to_string(axis) : name;
}

UrdfJoints::UrdfJoints(const LegsParameters& robot) : entries_(platform_joint_entries(robot.moves)) {
  AssembledLegs assembled = legs_model(robot);
  throw_if_any(std::move(assembled.problems));
  model_ = std::move(assembled.model);
  for (const std::size_t entry : entries_) names_.push_back(platform_joint_name(entry));
  std::vector<LegCoordinates> home;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    home.push_back(model_.legs[i].home);
    for (const LegJoint& joint : robot.legs[i].joints) {
      for (int axis = 1; axis <= axis_count(joint.kind); ++axis)
        names_.push_back(leg_joint_name(i, joint, axis));
    }
  }
  at_home_.resize(names_.size());
  fill(platform_at_home(model_), home, at_home_);
}

bool UrdfJoints::find(const Configuration& pose, std::vector<double>& positions) const {
  const WorkingMode at_home = WorkingMode::Zero(static_cast<Eigen::Index>(model_.legs.size()));
  PlatformTwist platform;
  LegsState state;
  if (!assemble(model_, pose, at_home, platform, state)) return false;
  positions.resize(names_.size());
  fill(pose_at(platform.origin, platform.axes), std::span(state.s).first(model_.legs.size()), positions);
  return true;
}

void UrdfJoints::fill(const Eigen::Isometry3d& platform, std::span<const LegCoordinates> legs,
                      std::vector<double>& positions) const {
  const Eigen::Vector3d angles = roll_pitch_yaw(platform.linear());
  auto next = positions.begin();
  for (const std::size_t entry : entries_) {
    const auto row = static_cast<Eigen::Index>(entry % 3);
    *next++ = entry < 3 ? platform.translation()[row] : angles[row];
  }
  for (std::size_t i = 0; i < legs.size(); ++i) {
    for (const ChainJoint& joint : model_.legs[i].chain.joints) *next++ = joint.position(legs[i]);
  }
}

}  // namespace flinch
