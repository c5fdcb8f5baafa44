#pragma once

#include <vector>

#include "calibration/calibration_result.h"
#include "systems/robot/imu_mount.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

struct Recording;

/// A recording of motion with an IMU on the platform.
struct ImuRecording {
  CalibrationSource source;
  const Recording* recording = nullptr;
};

/// Where an IMU sits on the platform and how it is turned, its biases and how late it is. `believed`: where
/// it was thought to sit. Throws SetupError with all that forbids it.
CalibrationResult calibrate_imu_pose(const ParallelRobot& robot, const ImuMount& believed,
                                     const std::vector<ImuRecording>& recordings);

}  // namespace flinch
