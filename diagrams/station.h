#pragma once

#include <optional>

#include "systems/framework/port.h"
#include "systems/signals/base_force_reading.h"
#include "systems/signals/brake_command.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/station_status.h"
#include "systems/signals/torque_command.h"

namespace flinch {

/// The contract of whatever stands for the robot, simulated, real or recorded: the ports of a nested diagram.
/// A reading that is not there, late or broken is marked invalid; it is never zero instead.
struct Station {
  InputPort<TorqueCommand> torque_command;
  InputPort<BrakeCommand> brake;

  OutputPort<JointReading> joints;
  OutputPort<DriveReading> drives;
  OutputPort<ImuReading> imu;
  OutputPort<StationStatus> status;
  std::optional<OutputPort<ForceTorqueReading>> force_torque;  ///< where the instrument is mounted
  std::optional<OutputPort<BaseForceReading>> base_forces{};   ///< where sensors are below the base joints
};

}  // namespace flinch
