#pragma once

#include <memory>

#include "diagrams/contact_control_settings.h"
#include "diagrams/station.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/tick_timing.h"
#include "systems/signals/operator_command.h"

namespace flinch {

/// The ports of the contact-control pipeline.
struct ContactControl {
  InputPort<JointReading> joints;
  InputPort<DriveReading> drives;
  InputPort<StationStatus> status;
  InputPort<OperatorCommand> operator_command;
  InputPort<TickTiming> tick_timing;  ///< for RealtimeRunner::feed_timing(); not valid in simulated time

  OutputPort<TorqueCommand> torque_command;  ///< from the torque gate, as is `brake`
  OutputPort<BrakeCommand> brake;

  // What is worth recording.
  OutputPort<JointMotion> joint_motion;
  OutputPort<PlatformMotion> platform_motion;
  OutputPort<WorkspaceMeasures> measures;
  OutputPort<DriveTorque> drive_torque;
  OutputPort<WrenchEstimate> wrench_estimate;
  OutputPort<ContactDetection> detection;
  OutputPort<ReactionState> reaction_state;
  OutputPort<PlatformReference> reference;  ///< that is being followed
  OutputPort<ImpedanceWrench> nominal_wrench;
  OutputPort<ImpedanceWrench> reaction_wrench;
  OutputPort<TorqueCommand> requested_torque;  ///< what the laws ask for, before the gate
  OutputPort<FaultReport> faults;
  OutputPort<GateStatus> gate;
};

/// Adds the whole pipeline to `builder`, as one nested diagram named "control" that runs at ticks of 1 ms:
///
///   joints -> velocity filter -> forward kinematics -> model -> momentum observer -> contact detector
///          -> reaction sequence -> trajectory | retraction -> impedance -> mode selector -> torque gate
///
/// It is the same whatever stands for the robot. Throws SetupError for settings that do not fit the robot.
ContactControl add_contact_control(DiagramBuilder& builder, const std::shared_ptr<const ParallelRobot>& robot,
                                   const ContactControlSettings& settings = {});

/// Connects a station with the pipeline, except for the operator's input.
void connect(DiagramBuilder& builder, const Station& station, const ContactControl& control);

}  // namespace flinch
