#include "import/instrument_axes.h"

#include <algorithm>

#include "systems/framework/recording.h"

namespace flinch {

InstrumentAxes::InstrumentAxes(const MappedLog& log)
    : robot_(log.mapping().scenario.robot.robot),
      mountings_(log.mapping().scenario.mountings),
      period_(log.period()) {
  Configuration pose = robot_->home_pose();
  MappedLog::Cursor active(log, "joints.active", robot_->drives());
  for (std::size_t k = 0; k < log.samples(); ++k) {
    if (k % Recording::block == 0) begin_.push_back(pose);
    axes_at(active.at(k), static_cast<Time::rep>(k) * period_, pose);
  }
}

std::vector<Eigen::Matrix3d> InstrumentAxes::read(const MappedLog& log, std::size_t first,
                                                  std::size_t count) const {
  const std::size_t block = first / Recording::block;
  Configuration pose = begin_[block];
  MappedLog::Cursor active(log, "joints.active", robot_->drives());
  std::vector<Eigen::Matrix3d> axes;
  for (std::size_t k = block * Recording::block; k < first + count; ++k) {
    const Eigen::Matrix3d at = axes_at(active.at(k), static_cast<Time::rep>(k) * period_, pose);
    if (k >= first) axes.push_back(at);
  }
  return axes;
}

Eigen::Matrix3d InstrumentAxes::axes_at(const JointVector& active, Time time, Configuration& pose) const {
  const ForwardSolution solution = robot_->forward_kinematics(active, pose, robot_->home_working_mode());
  if (!solution.converged) return Eigen::Matrix3d::Identity();
  pose = solution.pose;
  int body = 0;
  for (const InstrumentMounting& mounting : mountings_) {
    if (mounting.start <= time) body = mounting.body;
  }
  Kinematics at;
  robot_->kinematics(pose, PlatformVector::Zero(robot_->dof()), at);
  const int directions = robot_->space_dimension();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  const auto point = [&](const Eigen::Vector3d& in_body) {
    Eigen::Vector3d full = Eigen::Vector3d::Zero();
    full.head(directions) = robot_->point_on_body(at, BodyId::from_index(body), in_body.head(directions));
    return full;
  };
  for (int i = 0; i < directions; ++i)
    axes.col(i) = point(Eigen::Vector3d::Unit(i)) - point(Eigen::Vector3d::Zero());
  return axes;
}

}  // namespace flinch
