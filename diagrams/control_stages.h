#pragma once

#include <optional>
#include <vector>

#include "diagrams/stage.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/constraint_state.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/contact_features.h"
#include "systems/signals/contact_location.h"
#include "systems/signals/contact_phase.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/followed_task.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_motion.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/particle_cloud.h"
#include "systems/signals/platform_acceleration.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/reset_command.h"
#include "systems/signals/station_status.h"
#include "systems/signals/task_energies.h"
#include "systems/signals/torque_command.h"
#include "systems/signals/workspace_measures.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// What the station tells: inputs of the control path.
struct SensedPorts {
  InputPort<JointReading> joints;
  InputPort<DriveReading> drives;
  InputPort<StationStatus> status;
};

/// How the robot moves, and its model there.
struct MotionPorts : SensedPorts {
  OutputPort<JointMotion> joint_motion;
  OutputPort<PlatformMotion> platform;
  OutputPort<Kinematics> kinematics;
  OutputPort<Dynamics> dynamics;
  OutputPort<WorkspaceMeasures> measures;
  OutputPort<DriveTorque> drive_torque;
  OutputPort<ImuReading> imu;  ///< never valid where the station has none, nor while it is in doubt
};

/// And how it accelerates.
struct AcceleratedPorts : MotionPorts {
  OutputPort<PlatformAcceleration> acceleration;  ///< of the followed source; never valid where there is none
  std::vector<Named<OutputPort<PlatformAcceleration>>> accelerations;  ///< of every one
};

/// What pushes it.
struct EstimatePorts : AcceleratedPorts {
  OutputPort<WrenchEstimate> wrench;                         ///< of the followed estimator
  std::vector<Named<OutputPort<WrenchEstimate>>> estimates;  ///< of every one
  OutputPort<ResetCommand> reset;  ///< the operator wants what has latched to let go
};

/// Whether anything touches it, and what tells what.
struct ContactPorts : EstimatePorts {
  OutputPort<ContactDetection> detection;       ///< of the followed detector
  OutputPort<ContactPhase> contact;             ///< one contact after the other
  OutputPort<WrenchEstimate> isolation_wrench;  ///< of an observer that is faster than the one that detects
  OutputPort<WrenchEstimate> isolation_change;  ///< what that has changed by of late
  OutputPort<ContactFeatures> features;         ///< of that wrench, as the next
  OutputPort<ContactEvidence> evidence;         ///< weighed while a contact lasts
};

/// What touches it.
struct ClassifiedPorts : ContactPorts {
  OutputPort<ContactClassification> classification;  ///< of the followed classifier
};

/// Where and how hard, as a locator says.
struct LocatorPorts {
  OutputPort<ContactLocation> location;
  std::optional<OutputPort<ParticleCloud>> cloud{};  ///< of a locator that has particles
};

/// What it shall do about that.
struct ReactionPorts : ClassifiedPorts {
  OutputPort<ContactLocation> location;  ///< of the followed locator
  OutputPort<ReactionState> reaction;
  OutputPort<PlatformReference> nominal;  ///< the nominal motion
};

/// What a law asks of the drives, and what it follows. The torque does not leave the torque gate but by its
/// rules; whatever the mode, it is computed at every tick.
struct LawPorts {
  OutputPort<TorqueCommand> torque;
  /// Of a reaction: `finished` ends it. Not valid where there is nothing to be followed.
  OutputPort<PlatformReference> reference;
  std::optional<OutputPort<ConstraintState>> constraints{};  ///< of a law that keeps some
  std::optional<OutputPort<TaskEnergies>> energies{};        ///< of a law that serves tasks by torques
  std::optional<OutputPort<FollowedTask>> task{};            ///< of a reaction that serves tasks
  bool at_once = false;  ///< a reaction that is not blended in: as fast as torques may change
};

using VelocitySource = Stage<SensedPorts, OutputPort<JointMotion>>;
using AccelerationSource = Stage<MotionPorts, OutputPort<PlatformAcceleration>>;
using WrenchEstimator = Stage<AcceleratedPorts, OutputPort<WrenchEstimate>>;
using DetectionStage = Stage<EstimatePorts, OutputPort<ContactDetection>>;
using ContactClassifier = Stage<ContactPorts, OutputPort<ContactClassification>>;
using ContactLocatorStage = Stage<ClassifiedPorts, LocatorPorts>;
using ControlLaw = Stage<ReactionPorts, LawPorts>;

/// The stages of a control path. Those that are not followed run for comparison alone: they are recorded and
/// have no effect.
struct ControlStages {
  Stages<VelocitySource> velocities;
  Stages<AccelerationSource> accelerations;  ///< may be none
  Stages<WrenchEstimator> estimators;
  Stages<DetectionStage> detectors;
  Stages<ContactClassifier> classifiers;
  Stages<ContactLocatorStage> locators;
  Stages<ControlLaw> nominal_laws;   ///< in the mode `nominal`
  Stages<ControlLaw> reaction_laws;  ///< in the modes `react` and `hold`
};

/// One stage of each kind, as their settings say: "velocity_filter", "momentum_observer", "contact_detector",
/// "model_classifier", "closed_form", "nominal_impedance" and "retraction", an impedance that follows a
/// retreat; no acceleration.
ControlStages standard_stages();

/// All stages that flinch has, of which a scenario file names those that run: the standard ones first, then
/// classifiers that were added.
ControlStages known_stages();

/// Lets scenario files name one more classifier, anywhere in this program; of the same name, it takes the
/// place of the one before. Call it from one thread, before anything is read.
void add_known_classifier(ContactClassifier classifier);

/// All that is wrong with the choice of stages, one sentence each: no stage of a kind, names used twice or of
/// other characters, a followed one that there is not.
std::vector<std::string> problems(const ControlStages& stages);

}  // namespace flinch
