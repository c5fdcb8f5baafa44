#pragma once

#include <string>
#include <vector>

#include "calibration/calibration_result.h"
#include "systems/robot/drive_parameters.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/instrument_mounting.h"

namespace flinch {

struct Recording;

/// A recording of rope pulls, and what its scenario says of it.
struct PullRecording {
  CalibrationSource source;
  const Recording* recording = nullptr;
  std::vector<InstrumentMounting> mountings;
};

/// What is believed of the robot before.
struct TorqueConstantBelief {
  const ParallelRobot* robot = nullptr;
  DriveParameters drives;
  JointVector constant;  ///< with which the recordings were made [Nm/A or N/A]
};

/// The torque constant of each drive from rope pulls at an instrument on the bodies of the robot. `unseen`:
/// recordings that are not used, on which the errors of the platform's wrench are told, by body. Throws
/// SetupError with all that forbids it.
CalibrationResult calibrate_torque_constants(const TorqueConstantBelief& belief,
                                             const std::vector<PullRecording>& recordings,
                                             const std::vector<PullRecording>& unseen);

}  // namespace flinch
