#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/workspace_measures.h"

namespace flinch {

/// The robot's model at the measured motion: evaluated once a tick here, read by all who need it. Where the
/// motion is not valid or the model cannot serve it, the outputs are finite and marked invalid.
class RobotModel final : public System {
 public:
  explicit RobotModel(std::shared_ptr<const ParallelRobot> robot) : robot_(std::move(robot)) {}

  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  OutputPort<Kinematics> kinematics = output<&RobotModel::kinematics_of>("kinematics", platform);
  OutputPort<Dynamics> dynamics = output<&RobotModel::dynamics_of>("dynamics", kinematics);
  OutputPort<WorkspaceMeasures> measures = output<&RobotModel::measures_of>("measures", kinematics);

 private:
  void kinematics_of(const PlatformMotion& motion, Kinematics& result) const;
  void dynamics_of(const Kinematics& now, Dynamics& result) const;
  WorkspaceMeasures measures_of(const Kinematics& now) const;

  std::shared_ptr<const ParallelRobot> robot_;
};

}  // namespace flinch
