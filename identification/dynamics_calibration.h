#pragma once

#include <vector>

#include "calibration/calibration_result.h"
#include "systems/framework/time.h"
#include "systems/robot/drive_parameters.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

struct Recording;

/// A recording of motion without contact.
struct MotionRecording {
  CalibrationSource source;
  const Recording* recording = nullptr;
};

/// What is believed of the robot before.
struct DynamicsBelief {
  const ParallelRobot* robot = nullptr;
  DriveParameters drives;
  JointVector constant;   ///< torque constants, calibrated [Nm/A or N/A]
  Time control_period{};  ///< after which the drives get another current; zero: that of each recording
};

/// Inertial parameters, friction, cogging and how far torques are behind currents, from motion without
/// contact. `unseen`: recordings that are not used, on which the errors of the predicted torque are told, by
/// drive. Throws SetupError with all that forbids it.
CalibrationResult calibrate_dynamics(const DynamicsBelief& belief,
                                     const std::vector<MotionRecording>& recordings,
                                     const std::vector<MotionRecording>& unseen);

}  // namespace flinch
