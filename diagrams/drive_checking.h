#pragma once

#include "diagrams/control_stages.h"
#include "systems/motion/platform_trajectory.h"
#include "systems/signals/drive_check_status.h"

namespace flinch {

/// The torques that the gate is asked to let through, and what is known of the drives that shall make them.
struct CheckedTorques {
  OutputPort<TorqueCommand> torque;
  OutputPort<DriveCheckStatus> status;
  bool are_checked;  ///< before the first motion
};

/// Lets the drives be tried while the laws hold the robot at rest, where that is wanted and commands reach
/// them. `torque`: of the laws; `trajectory`: the nominal motion, which waits until they are known.
CheckedTorques add_drive_check(const StageContext& site, const ReactionPorts& given,
                               OutputPort<TorqueCommand> torque, const PlatformTrajectory& trajectory);

}  // namespace flinch
