#include "diagrams/contact_control.h"

#include <optional>
#include <utility>

#include "diagrams/added_stages.h"
#include "diagrams/base_force_isolation.h"
#include "diagrams/control_rate.h"
#include "diagrams/drive_checking.h"
#include "diagrams/isolation_stages.h"
#include "diagrams/low_latency_motion.h"
#include "diagrams/safety_filtering.h"
#include "diagrams/shared_parts.h"
#include "diagrams/watched_imu.h"
#include "systems/contact/oracle_contact.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/constant.h"
#include "systems/laws/operator_buttons.h"
#include "systems/laws/zero_gravity.h"
#include "systems/model/robot_model.h"
#include "systems/safety/fault_monitor.h"

namespace flinch {
namespace {

using Robot = std::shared_ptr<const ParallelRobot>;

/// The control path while it is wired.
struct Path {
  DiagramBuilder& builder;
  const Robot& robot;
  const ContactControlSettings& settings;
  std::shared_ptr<SharedParts> shared = std::make_shared<SharedParts>();
  /// Which stages judge by; see StageContext.
  std::shared_ptr<std::vector<Named<OutputPort<DriveLoad>>>> loads =
      std::make_shared<std::vector<Named<OutputPort<DriveLoad>>>>();

  StageContext site(const std::string& name) const {
    return {builder, name, robot, settings, *shared, loads.get()};
  }

  template <class Given, class Port>
  AddedStages<Port> add(const Stages<Stage<Given, Port>>& stages, const Given& given) const {
    AddedStages<Port> added;
    for (const Stage<Given, Port>& stage : stages.all)
      added.all.push_back({stage.name, stage.add(site(stage.name), given)});
    added.followed = followed_name(stages);
    return added;
  }

  /// Shows what the stages that are not followed offer, as `prefix` + "_" + their names.
  template <class T>
  std::vector<Named<OutputPort<T>>> show_others(const std::string& prefix,
                                                const AddedStages<OutputPort<T>>& added) const {
    std::vector<Named<OutputPort<T>>> shown = added.others();
    for (Named<OutputPort<T>>& each : shown) {
      each.name = prefix + "_" + each.name;
      each.port = builder.export_output(each.name, each.port);
    }
    return shown;
  }
};

/// What the operator wants.
struct Operator {
  OperatorButtons& buttons;
  ReactionSequence& sequence;
  PlatformTrajectory& trajectory;
  InputPort<TargetCommand> target;
};

/// Torques that are ready for every mode.
struct Laws {
  AddedStages<LawPorts> nominal;
  AddedStages<LawPorts> reaction;
  ZeroGravity& zero_gravity;
  ControlledStop& stop;
  ModeSelector& selector;
  LimitedTorques kept;  ///< of the selector's torques
};

/// And whether they may leave.
struct Safety {
  FaultMonitor& monitor;
  TorqueGate& gate;
};

SensedPorts add_inputs(DiagramBuilder& builder) {
  return {builder.input<JointReading>("joints"), builder.input<DriveReading>("drives"),
          builder.input<StationStatus>("status")};
}

MotionPorts add_motion(const Path& path, const SensedPorts& sensed, OutputPort<JointMotion> joint_motion,
                       OutputPort<ImuReading> imu) {
  auto& pose =
      path.builder.add<ForwardKinematics>("forward_kinematics", path.robot, path.settings.forward_kinematics);
  auto& model = path.builder.add<RobotModel>("model", path.robot);
  path.builder.connect(sensed.joints, pose.joints);
  path.builder.connect(joint_motion, pose.motion);
  path.builder.connect(pose.platform, model.platform);
  const OutputPort<DriveTorque> torque =
      add_drive_torque(path.site("drive_torque"), sensed, torque_low_pass(path.settings));
  return {sensed, joint_motion, pose.platform, model.kinematics, model.dynamics, model.measures, torque, imu};
}

OutputPort<PlatformAcceleration> followed_acceleration(
    const Path& path, const AddedStages<OutputPort<PlatformAcceleration>>& sources) {
  if (!sources.all.empty()) return sources.port();
  return path.builder.add<Constant<PlatformAcceleration>>("no_acceleration", PlatformAcceleration()).value;
}

Operator add_operator(const Path& path, const EstimatePorts& given, OperatorButtons& buttons,
                      OutputPort<ContactDetection> detection) {
  const auto target = path.builder.optional_input<TargetCommand>("target");
  const Operator added{
      buttons, path.builder.add<ReactionSequence>("reaction_sequence", path.settings.sequence),
      path.builder.add<PlatformTrajectory>("trajectory", path.robot, path.settings.trajectory), target};
  path.builder.connect(buttons.reset, added.sequence.reset);
  path.builder.connect(detection, added.sequence.detection);
  path.builder.connect(given.joint_motion, added.sequence.joints);
  path.builder.connect(added.sequence.reaction_state, added.trajectory.reaction);
  path.builder.connect(given.platform, added.trajectory.platform);
  path.builder.connect(buttons.start, added.trajectory.start);
  path.builder.connect(target, added.trajectory.target);
  return added;
}

/// What a hard contact is answered with.
OutputPort<TorqueCommand> add_yielding(const Path& path, const ReactionPorts& given,
                                       const ZeroGravity& zero_gravity) {
  if (!path.settings.yielding) return zero_gravity.torque;
  auto& law = path.builder.add<ControlledStop>("yielding", path.robot, *path.settings.yielding);
  path.builder.connect(zero_gravity.torque, law.zero_gravity);
  path.builder.connect(given.joint_motion, law.joints);
  return law.torque;
}

Laws add_laws(const Path& path, const ReactionPorts& given) {
  DiagramBuilder& builder = path.builder;
  const AddedStages<LawPorts> nominal = path.add(path.settings.stages.nominal_laws, given);
  const AddedStages<LawPorts> reaction = path.add(path.settings.stages.reaction_laws, given);
  ModeSelectorSettings modes = path.settings.modes;
  modes.reacts_at_once = reaction.port().at_once;
  Laws laws{nominal,
            reaction,
            builder.add<ZeroGravity>("zero_gravity"),
            builder.add<ControlledStop>("controlled_stop", path.robot, path.settings.controlled_stop),
            builder.add<ModeSelector>("mode_selector", modes),
            {}};
  builder.connect(given.kinematics, laws.zero_gravity.kinematics);
  builder.connect(given.dynamics, laws.zero_gravity.dynamics);
  builder.connect(laws.zero_gravity.torque, laws.stop.zero_gravity);
  builder.connect(given.joint_motion, laws.stop.joints);

  builder.connect(given.reaction, laws.selector.reaction);
  builder.connect(laws.nominal.port().torque, laws.selector.nominal);
  builder.connect(laws.reaction.port().torque, laws.selector.reacting);
  builder.connect(add_yielding(path, given, laws.zero_gravity), laws.selector.yielding);
  builder.connect(laws.zero_gravity.torque, laws.selector.zero_gravity);
  builder.connect(laws.nominal.port().reference, laws.selector.nominal_reference);
  builder.connect(laws.reaction.port().reference, laws.selector.reaction_reference);
  laws.kept = add_safety_filter(path.site("limits"), given, laws.selector.torque);
  return laws;
}

/// Lets the monitor read everything, and others what it finds.
void connect(const Path& path, const WatchedImu& imu, const ReactionPorts& given, const Safety& safety) {
  DiagramBuilder& builder = path.builder;
  PlausibilityMonitor& monitor = imu.monitor;
  builder.connect(given.joints, monitor.joints);
  builder.connect(given.drives, monitor.drives);
  builder.connect(imu.reading, monitor.imu);
  builder.connect(add_present_torque(path.site("plausibility_monitor"), given), monitor.torque);
  builder.connect(given.reset, monitor.reset);
  builder.connect(given.status, monitor.station);
  builder.connect(given.platform, monitor.platform);
  builder.connect(given.kinematics, monitor.kinematics);
  builder.connect(given.dynamics, monitor.dynamics);
  builder.connect(safety.gate.torque_command, monitor.commanded);
  builder.connect(safety.gate.brake, monitor.brake);
  builder.connect(safety.gate.status, monitor.gate);
  builder.connect(monitor.plausibility, safety.monitor.plausibility);
}

/// The controlled stop, within the limits that the laws' torques keep.
OutputPort<TorqueCommand> stop_of(const Path& path, const Laws& laws, const Safety& safety) {
  if (!laws.kept.followed) return laws.stop.torque;
  const OutputPort<TorqueCommand> commanded = safety.gate.torque_command;
  path.builder.connect(commanded, *laws.kept.commanded);
  return add_kept_stop(path.site("stop_limits"), *laws.kept.followed,
                       {laws.stop.torque, safety.monitor.faults, safety.gate.status, commanded});
}

Safety add_safety(const Path& path, const ReactionPorts& given, const Laws& laws,
                  const CheckedTorques& checked) {
  DiagramBuilder& builder = path.builder;
  const Safety safety{builder.add<FaultMonitor>("fault_monitor", path.robot, path.settings.faults),
                      builder.add<TorqueGate>("torque_gate", path.settings.torque_gate)};
  builder.connect(given.joints, safety.monitor.joints);
  builder.connect(given.drives, safety.monitor.drives);
  builder.connect(given.joint_motion, safety.monitor.motion);
  builder.connect(given.platform, safety.monitor.platform);
  builder.connect(given.kinematics, safety.monitor.kinematics);
  builder.connect(given.measures, safety.monitor.measures);
  builder.connect(given.detection, safety.monitor.detection);
  builder.connect(given.reaction, safety.monitor.reaction);
  builder.connect(laws.selector.reference, safety.monitor.reference);
  builder.connect(checked.torque, safety.monitor.command);
  builder.connect(checked.status, safety.monitor.drive_check);
  builder.connect(safety.monitor.faults, safety.gate.faults);
  builder.connect(checked.torque, safety.gate.command);
  builder.connect(stop_of(path, laws, safety), safety.gate.stop);
  builder.connect(given.reset, safety.gate.reset);
  builder.connect(safety.gate.torque_command, laws.selector.commanded);
  return safety;
}

/// Connects what blocks learn one tick later, and what the operator presses.
InputPort<OperatorCommand> connect_back(DiagramBuilder& builder, const SensedPorts& sensed, const Laws& laws,
                                        const Safety& safety, const Operator& wanted) {
  builder.connect(laws.reaction.port().reference, wanted.sequence.reaction);
  builder.connect(safety.gate.status, wanted.sequence.gate);
  const auto pressed = builder.export_input("operator_command", wanted.buttons.buttons);
  builder.connect(pressed, safety.monitor.buttons);
  builder.connect(sensed.status, safety.monitor.station);
  return pressed;
}

/// Lets a contact detector follow each estimator that the others do not follow, for comparison.
std::vector<Named<OutputPort<ContactDetection>>> show_detections_by(
    const Path& path, const AddedStages<OutputPort<WrenchEstimate>>& estimators,
    OutputPort<ResetCommand> reset) {
  std::vector<Named<OutputPort<ContactDetection>>> shown;
  for (const Named<OutputPort<WrenchEstimate>>& estimator : estimators.others()) {
    const std::string name = "detection_by_" + estimator.name;
    auto& detector =
        path.builder.add<ContactDetector>(name, path.robot, path.settings.detector_of(estimator.name));
    path.builder.connect(estimator.port, detector.wrench);
    path.builder.connect(reset, detector.reset);
    shown.push_back({name, path.builder.export_output(name, detector.contact)});
  }
  return shown;
}

/// That of the followed source is "acceleration".
std::vector<Named<OutputPort<PlatformAcceleration>>> show_accelerations(
    const Path& path, const AddedStages<OutputPort<PlatformAcceleration>>& sources) {
  auto shown = path.show_others("acceleration", sources);
  if (!sources.all.empty()) {
    shown.push_back({"acceleration", path.builder.export_output("acceleration", sources.port())});
  }
  return shown;
}

std::vector<Named<OutputPort<DriveLoad>>> show_loads(const Path& path) {
  std::vector<Named<OutputPort<DriveLoad>>> shown;
  for (const auto& [detector, load] : *path.loads) {
    const std::string name = "load_" + detector;
    shown.push_back({name, path.builder.export_output(name, load)});
  }
  return shown;
}

/// The torques of laws that are not followed.
std::vector<Named<OutputPort<TorqueCommand>>> show_torques(const Path& path, const Laws& laws) {
  std::vector<Named<OutputPort<TorqueCommand>>> shown;
  for (const AddedStages<LawPorts>* kind : {&laws.nominal, &laws.reaction}) {
    for (const Named<LawPorts>& law : kind->others()) {
      const std::string name = "torque_" + law.name;
      shown.push_back({name, path.builder.export_output(name, law.port.torque)});
    }
  }
  return shown;
}

/// What classifiers and locators say.
struct Isolation {
  ContactPorts contact;
  AddedStages<OutputPort<ContactClassification>> classifiers;
  AddedStages<LocatorPorts> locators;

  ClassifiedPorts classified() const { return {contact, classifiers.port()}; }
};

Isolation add_isolation(const Path& path, const EstimatePorts& given,
                        OutputPort<ContactDetection> detection) {
  Isolation isolation{flinch::add_isolation(path.site("isolation"), given, detection), {}, {}};
  isolation.classifiers = path.add(path.settings.stages.classifiers, isolation.contact);
  isolation.locators = path.add(path.settings.stages.locators, isolation.classified());
  return isolation;
}

OtherStages show_others(const Path& path, const AddedStages<OutputPort<JointMotion>>& velocities,
                        const AddedStages<OutputPort<PlatformAcceleration>>& accelerations,
                        const AddedStages<OutputPort<WrenchEstimate>>& estimators,
                        OutputPort<ResetCommand> reset) {
  OtherStages shown;
  shown.joint_motions = path.show_others("joint_motion", velocities);
  shown.accelerations = show_accelerations(path, accelerations);
  shown.wrenches = path.show_others("wrench", estimators);
  shown.loads = show_loads(path);
  shown.detections_by_estimator = show_detections_by(path, estimators, reset);
  return shown;
}

/// What classifiers and locators say that are not followed, and the particles of all.
void show_isolation(const Path& path, const Isolation& isolation, OtherStages& shown) {
  shown.classifications = path.show_others("classification", isolation.classifiers);
  for (const Named<LocatorPorts>& locator : isolation.locators.others()) {
    const std::string name = "location_" + locator.name;
    shown.locations.push_back({name, path.builder.export_output(name, locator.port.location)});
  }
  for (const Named<LocatorPorts>& locator : isolation.locators.all) {
    if (!locator.port.cloud) continue;
    const std::string name = "particles_" + locator.name;
    shown.clouds.push_back({name, path.builder.export_output(name, *locator.port.cloud)});
  }
}

/// The torques of laws that are not followed, the constraints of all, energies and task of the followed ones.
void show_laws(const Path& path, const Laws& laws, OtherStages& shown) {
  shown.torques = show_torques(path, laws);
  for (const AddedStages<LawPorts>* kind : {&laws.nominal, &laws.reaction}) {
    for (const Named<LawPorts>& law : kind->all) {
      const std::string name = "constraints_" + law.name;
      if (law.port.constraints)
        shown.constraints.push_back({name, path.builder.export_output(name, *law.port.constraints)});
    }
    const std::string name = kind == &laws.nominal ? "energies_nominal" : "energies_reaction";
    if (!kind->all.empty() && kind->port().energies)
      shown.energies.push_back({name, path.builder.export_output(name, *kind->port().energies)});
  }
  if (!laws.reaction.all.empty() && laws.reaction.port().task)
    shown.tasks.push_back(
        {"reaction_task", path.builder.export_output("reaction_task", *laws.reaction.port().task)});
}

void show(const Path& path, const AddedStages<OutputPort<ContactDetection>>& detectors,
          const Isolation& isolation, const Laws& laws, const CheckedTorques& checked, OtherStages& shown) {
  shown.detections = path.show_others("detection", detectors);
  show_isolation(path, isolation, shown);
  show_laws(path, laws, shown);
  if (checked.are_checked)
    shown.drive_checks.push_back({"drive_check", path.builder.export_output("drive_check", checked.status)});
}

/// Lets the reaction believe who knows what touches the robot, where the settings say so.
struct Told {
  InputPort<ContactClassification> classification;
  InputPort<ContactLocation> location;
};

Told add_told_contact(const Path& path, ReactionPorts& reaction) {
  auto& told = path.builder.add<OracleContact>("told_contact");
  const Told given{path.builder.optional_input<ContactClassification>("told_classification"),
                   path.builder.optional_input<ContactLocation>("told_location")};
  path.builder.connect(given.classification, told.told_classification);
  path.builder.connect(given.location, told.told_location);
  if (path.settings.contact_is_told) {
    reaction.classification = told.classification;
    reaction.location = told.location;
  }
  return given;
}

const ContactControlSettings& checked(const ContactControlSettings& settings) {
  throw_if_any(problems(settings.stages));
  throw_if_any(problems_of_rate(settings));
  return settings;
}

}  // namespace

ContactControl add_contact_control(DiagramBuilder& outer, const Robot& robot,
                                   const ContactControlSettings& settings) {
  DiagramBuilder builder("control", checked(settings).control_period);
  const Path path{builder, robot, settings};
  const SensedPorts sensed = add_inputs(builder);
  const auto velocities = path.add(settings.stages.velocities, sensed);
  const WatchedImu imu = add_watched_imu(path.site("plausibility_monitor"));
  const MotionPorts motion = add_motion(path, sensed, velocities.port(), imu.monitor.believed_imu);
  const auto accelerations = path.add(settings.stages.accelerations, motion);
  const AcceleratedPorts accelerated{motion, followed_acceleration(path, accelerations), accelerations.all};
  const auto estimators = path.add(settings.stages.estimators, accelerated);
  auto& buttons = builder.add<OperatorButtons>("operator_buttons");
  const EstimatePorts estimated{accelerated, estimators.port(), estimators.all, buttons.reset};
  const auto detectors = path.add(settings.stages.detectors, estimated);
  const Isolation isolation = add_isolation(path, estimated, detectors.port());
  const Operator wanted = add_operator(path, estimated, buttons, detectors.port());
  ReactionPorts reaction{isolation.classified(), isolation.locators.port().location,
                         wanted.sequence.reaction_state, wanted.trajectory.reference};
  const Told told = add_told_contact(path, reaction);
  const Laws laws = add_laws(path, reaction);
  const auto tried = add_drive_check(path.site("drive_check"), reaction, laws.kept.torque, wanted.trajectory);
  const Safety safety = add_safety(path, reaction, laws, tried);
  connect(path, imu, reaction, safety);
  OtherStages others = show_others(path, velocities, accelerations, estimators, buttons.reset);
  show(path, detectors, isolation, laws, tried, others);
  const ContactControl control{
      .joints = sensed.joints,
      .drives = sensed.drives,
      .imu = imu.reading,
      .status = sensed.status,
      .operator_command = connect_back(builder, sensed, laws, safety, wanted),
      .target = wanted.target,
      .told_classification = told.classification,
      .told_location = told.location,
      .base_forces = add_base_forces(path.site("base_forces"), isolation.contact, others),
      .tick_timing = builder.export_input("tick_timing", safety.monitor.timing),
      .torque_command = builder.export_output("torque_command", safety.gate.torque_command),
      .brake = builder.export_output("brake", safety.gate.brake),
      .joint_motion = builder.export_output("joint_motion", motion.joint_motion),
      .platform_motion = builder.export_output("platform_motion", motion.platform),
      .measures = builder.export_output("measures", motion.measures),
      .drive_torque = builder.export_output("drive_torque", motion.drive_torque),
      .wrench_estimate = builder.export_output("wrench_estimate", estimated.wrench),
      .detection = builder.export_output("detection", reaction.detection),
      .contact = builder.export_output("contact_phase", reaction.contact),
      .isolation_wrench = builder.export_output("isolation_wrench", reaction.isolation_wrench),
      .features = builder.export_output("features", reaction.features),
      .evidence = builder.export_output("evidence", reaction.evidence),
      .classification = builder.export_output("classification", isolation.classifiers.port()),
      .location = builder.export_output("location", isolation.locators.port().location),
      .reaction_state = builder.export_output("reaction_state", reaction.reaction),
      .reference = builder.export_output("reference", laws.selector.reference),
      .requested_torque = builder.export_output("requested_torque", laws.selector.torque),
      .limits = builder.export_output("limits", laws.kept.status),
      .braking = builder.export_output("braking", laws.kept.braking),
      .plausibility = builder.export_output("plausibility", imu.monitor.plausibility),
      .faults = builder.export_output("faults", safety.monitor.faults),
      .gate = builder.export_output("gate", safety.gate.status),
      .others = others};
  outer.add(builder.build());
  return control;
}

void connect(DiagramBuilder& builder, const Station& station, const ContactControl& control) {
  builder.connect(station.joints, control.joints);
  builder.connect(station.drives, control.drives);
  builder.connect(station.imu, control.imu);
  builder.connect(station.status, control.status);
  if (station.base_forces && control.base_forces) builder.connect(*station.base_forces, *control.base_forces);
  builder.connect(control.torque_command, station.torque_command);
  builder.connect(control.brake, station.brake);
}

}  // namespace flinch
