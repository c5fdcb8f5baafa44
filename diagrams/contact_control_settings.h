#pragma once

#include <map>
#include <optional>
#include <string>

#include "diagrams/control_stages.h"
#include "diagrams/fused_detector_settings.h"
#include "diagrams/isolation_settings.h"
#include "diagrams/task_settings.h"
#include "systems/contact/contact_detector.h"
#include "systems/estimators/disturbance_filter.h"
#include "systems/estimators/imu_filter.h"
#include "systems/estimators/imu_residual.h"
#include "systems/estimators/momentum_kalman_filter.h"
#include "systems/estimators/momentum_observer.h"
#include "systems/estimators/sliding_mode_observer.h"
#include "systems/laws/controlled_stop.h"
#include "systems/laws/impedance_controller.h"
#include "systems/laws/mode_selector.h"
#include "systems/laws/reaction_sequence.h"
#include "systems/laws/safety_filter.h"
#include "systems/model/forward_kinematics.h"
#include "systems/motion/platform_trajectory.h"
#include "systems/motion/retraction.h"
#include "systems/safety/drive_check.h"
#include "systems/safety/fault_table.h"
#include "systems/safety/plausibility_limits.h"
#include "systems/safety/torque_gate.h"
#include "systems/sensors/drive_torque_mapping.h"
#include "systems/sensors/velocity_filter.h"

namespace flinch {

/// Reaction thresholds of one estimator; those of all count where it has none.
struct OwnThreshold {
  std::optional<ComponentBounds> force;   ///< [N]
  std::optional<ComponentBounds> moment;  ///< [Nm]
};

/// All that can be set in the contact-control pipeline. The defaults are those of the planar rig;
/// settings_for() (robot_settings.h) has those of any robot. Each block's own settings say what they mean and
/// where they come from.
struct ContactControlSettings {
  ControlStages stages = standard_stages();
  /// From tick to tick; know_period() (robot_settings.h) sets what follows from it.
  Time control_period = 1ms;

  // ---- what the sensors say
  VelocityFilterSettings velocity_filter;  ///< 30 Hz
  ForwardKinematicsSettings forward_kinematics;
  DriveTorqueSettings drive_torque;  ///< as default_drives() says until calibrated
  /// The drive torques go through the low pass of `velocity_filter`, so that they lag as the velocity does.
  bool aligned_with_velocity = true;

  ImuMount imu_mount;  ///< pose 1 of [RAL25] V-B; for all that reads the IMU
  /// Width of the range in which the stamps of an IMU err whose delay varies; for all that compares it with
  /// a model. 0: they are as exact as those of the rig.
  Time imu_stamp_spread{};
  ImuFilterSettings imu_ekf = published_imu_filter();
  ImuFilterSettings extended_imu_ekf = extended_imu_filter();
  ImuFilterSettings unscented_imu_filter = flinch::unscented_imu_filter();

  // ---- contacts
  MomentumObserverSettings momentum_observer;  ///< 20 1/s, [SafePR] V-A
  MomentumKalmanFilterSettings momentum_kalman_filter;
  SlidingModeObserverSettings sliding_mode_observer;
  DisturbanceFilterSettings disturbance_filter;
  ImuResidualSettings imu_residual;          ///< with `imu_mount` in the place of its own
  ContactDetectorSettings contact_detector;  ///< 10 N, 1 Nm; hard: 60 N, 3 Nm
  /// Reaction thresholds of detectors that follow these estimators.
  std::map<std::string, OwnThreshold> reaction_thresholds;
  /// The settings of a contact detector that follows `estimator`. Hard contacts are at least as hard as those
  /// that are reacted to.
  ContactDetectorSettings detector_of(const std::string& estimator) const;
  FusedDetectorSettings fused_detector;  ///< judges nothing until it is calibrated

  /// Reactions go by who tells the control path what touches the robot, and not by the followed classifier.
  bool contact_is_told = false;
  IsolationSettings isolation;  ///< what is touched, where and how hard

  // ---- what to do
  PlatformTrajectorySettings trajectory;  ///< stays where the robot is
  ImpedanceSettings impedance;            ///< 2 N/mm, 85 Nm/rad, critically damped
  RetractionSettings retraction;          ///< 0.10 m along the force
  /// Share of the translational stiffness that is left while reacting, 0 to 1. [SafePR] IV-A
  double reaction_stiffness = 1.0;
  TaskSettings tasks;  ///< of the laws that serve tasks by priority
  ReactionSequenceSettings sequence;
  /// After a hard contact: zero gravity that takes energy out. None: zero gravity alone, [SafePR] IV-A, which
  /// is no torque at all for a robot that moves horizontally: it coasts on.
  std::optional<ControlledStopSettings> yielding = ControlledStopSettings{.share_at_rest = 0.25};
  ModeSelectorSettings modes;   ///< blends over 10 ms
  SafetyFilterSettings limits;  ///< that the laws' torques keep; of settings_for(): those of the torque gate
  DisturbanceFilterSettings limits_filter{.pole = 400.0, .encoder_deviation = 7e-6, .sampling = {}};

  // ---- safety
  FaultLimits faults;
  PlausibilityLimits plausibility;  ///< with `imu_mount` in the place of its own
  bool checks_drives = false;       ///< before the first motion, where commands reach the robot
  DriveCheckSettings drive_check;   ///< of settings_for(): a torque that overcomes friction
  ControlledStopSettings controlled_stop;
  TorqueGateSettings torque_gate;  ///< 100 Nm, 20 Nm/ms
};

}  // namespace flinch
