#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/workspace_measures.h"

namespace flinch {

/// How near `robot` is to what it must stay away from; not valid where it cannot be.
WorkspaceMeasures workspace_measures(const Mechanism& robot, const Kinematics& now);

/// The robot's kinematics and equations of motion at a motion. Where that is not valid or the model cannot
/// serve it, the outputs are finite and marked invalid.
class MotionModel : public System {
 public:
  explicit MotionModel(std::shared_ptr<const ParallelRobot> robot) : robot_(std::move(robot)) {}

  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  OutputPort<Kinematics> kinematics = output<&MotionModel::kinematics_of>("kinematics", platform);
  OutputPort<Dynamics> dynamics = output<&MotionModel::dynamics_of>("dynamics", kinematics);

 protected:
  const ParallelRobot& robot() const { return *robot_; }

 private:
  void kinematics_of(const PlatformMotion& motion, Kinematics& result) const;
  void dynamics_of(const Kinematics& now, Dynamics& result) const;

  std::shared_ptr<const ParallelRobot> robot_;
};

/// The model at the measured motion: evaluated once a tick here, read by all who need it; and how far the
/// robot is from what it must avoid.
class RobotModel final : public MotionModel {
 public:
  using MotionModel::MotionModel;

  OutputPort<WorkspaceMeasures> measures = output<&RobotModel::measures_of>("measures", kinematics);

 private:
  WorkspaceMeasures measures_of(const Kinematics& now) const;
};

}  // namespace flinch
