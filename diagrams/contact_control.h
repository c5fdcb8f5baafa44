#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "diagrams/contact_control_settings.h"
#include "diagrams/station.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/tick_timing.h"
#include "systems/signals/base_force_estimate.h"
#include "systems/signals/base_force_reading.h"
#include "systems/signals/braking_status.h"
#include "systems/signals/limit_status.h"
#include "systems/signals/located_contacts.h"
#include "systems/signals/operator_command.h"
#include "systems/signals/plausibility.h"
#include "systems/signals/target_command.h"

namespace flinch {

/// What stages offer that run beside those which are followed, by names that a recording can use:
/// "wrench_" + the estimator's, and so on; and the followed "acceleration", where there is one.
struct OtherStages {
  std::vector<Named<OutputPort<JointMotion>>> joint_motions;
  std::vector<Named<OutputPort<PlatformAcceleration>>> accelerations;
  std::vector<Named<OutputPort<WrenchEstimate>>> wrenches;
  std::vector<Named<OutputPort<ContactDetection>>> detections;
  /// What a contact detector says that follows an estimator which the others do not: "detection_by_" + its
  /// name.
  std::vector<Named<OutputPort<ContactDetection>>> detections_by_estimator;
  std::vector<Named<OutputPort<TorqueCommand>>> torques;
  std::vector<Named<OutputPort<ContactClassification>>> classifications;
  std::vector<Named<OutputPort<ContactLocation>>> locations;
  /// "particles_" + the name of each locator that has some, whether it is followed or not.
  std::vector<Named<OutputPort<ParticleCloud>>> clouds;
  /// Of every law that keeps some, whether it is followed or not: "constraints_" + its name.
  std::vector<Named<OutputPort<ConstraintState>>> constraints;
  /// Of the followed laws, where they serve tasks by torques: "energies_nominal" and "energies_reaction".
  std::vector<Named<OutputPort<TaskEnergies>>> energies;
  /// What the followed law of the reaction leads, where it serves tasks: "reaction_task".
  std::vector<Named<OutputPort<FollowedTask>>> tasks;
  /// How the drives answered before the first motion, where that is checked: "drive_check".
  std::vector<Named<OutputPort<DriveCheckStatus>>> drive_checks;
  /// What detectors take for the loads of the drives, "load_" + their name.
  std::vector<Named<OutputPort<DriveLoad>>> loads;
  /// Where force sensors are below the base joints: "base_force" and "located_contacts".
  std::vector<Named<OutputPort<BaseForceEstimate>>> base_forces;
  std::vector<Named<OutputPort<LocatedContacts>>> located_contacts;
};

/// The ports of the contact-control pipeline.
struct ContactControl {
  InputPort<JointReading> joints;
  InputPort<DriveReading> drives;
  InputPort<ImuReading> imu;  ///< may be left open: no data
  InputPort<StationStatus> status;
  InputPort<OperatorCommand> operator_command;
  InputPort<TargetCommand> target;  ///< may be left open: none
  /// What touches the robot and where, from someone who knows; may be left open: nobody does.
  InputPort<ContactClassification> told_classification;
  InputPort<ContactLocation> told_location;
  std::optional<InputPort<BaseForceReading>> base_forces;  ///< may be left open: no data
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
  OutputPort<ContactPhase> contact;
  OutputPort<WrenchEstimate> isolation_wrench;
  OutputPort<ContactFeatures> features;
  OutputPort<ContactEvidence> evidence;
  OutputPort<ContactClassification> classification;
  OutputPort<ContactLocation> location;
  OutputPort<ReactionState> reaction_state;
  OutputPort<PlatformReference> reference;     ///< that is being followed
  OutputPort<TorqueCommand> requested_torque;  ///< what the laws ask for, before limits and gate
  OutputPort<LimitStatus> limits;
  OutputPort<BrakingStatus> braking;
  OutputPort<Plausibility> plausibility;
  OutputPort<FaultReport> faults;
  OutputPort<GateStatus> gate;
  OtherStages others;
};

/// Adds the whole pipeline to `builder`, as one nested diagram named "control" that runs at
/// `settings.control_period`:
///
///   joints -> velocity source -> forward kinematics -> model -> wrench estimator -> detector -> classifier
///          -> locator -> reaction sequence -> trajectory -> nominal law | reaction law -> mode selector
///          -> torque gate
///
/// Which sources, estimators, detectors, classifiers, locators and laws, `settings.stages` says. It is the
/// same whatever stands for the robot. Throws SetupError for settings that do not fit the robot, and as the
/// stages do.
ContactControl add_contact_control(DiagramBuilder& builder, const std::shared_ptr<const ParallelRobot>& robot,
                                   const ContactControlSettings& settings);

/// Connects a station with the pipeline, except for the operator's input.
void connect(DiagramBuilder& builder, const Station& station, const ContactControl& control);

}  // namespace flinch
