#include "diagrams/contact_control.h"

#include "systems/foundation/setup_error.h"
#include "systems/laws/operator_buttons.h"
#include "systems/laws/zero_gravity.h"
#include "systems/model/robot_model.h"
#include "systems/safety/fault_monitor.h"

namespace flinch {
namespace {

using Robot = std::shared_ptr<const ParallelRobot>;

/// Where the robot is and how it moves.
struct Sensing {
  VelocityFilter& velocity;
  ForwardKinematics& pose;
  RobotModel& model;
  DriveTorqueMapping& torque;
};

/// Whether it is touched.
struct Detection {
  MomentumObserver& observer;
  ContactDetector& detector;
};

/// What it shall do.
struct Reaction {
  OperatorButtons& buttons;
  ReactionSequence& sequence;
  PlatformTrajectory& trajectory;
  Retraction& retraction;
};

/// With which torques.
struct Laws {
  ImpedanceController& nominal;
  ImpedanceController& reaction;
  ZeroGravity& zero_gravity;
  ControlledStop& stop;
  ModeSelector& selector;
};

/// And whether they may leave.
struct Safety {
  FaultMonitor& monitor;
  TorqueGate& gate;
};

Sensing add_sensing(DiagramBuilder& builder, const Robot& robot, const ContactControlSettings& settings) {
  const Sensing sensing{
      builder.add<VelocityFilter>("velocity_filter", robot, settings.velocity_filter),
      builder.add<ForwardKinematics>("forward_kinematics", robot, settings.forward_kinematics),
      builder.add<RobotModel>("model", robot),
      builder.add<DriveTorqueMapping>("drive_torque", robot, settings.drive_torque)};
  builder.connect(sensing.velocity.motion, sensing.pose.motion);
  builder.connect(sensing.pose.platform, sensing.model.platform);
  return sensing;
}

Detection add_detection(DiagramBuilder& builder, const Robot& robot, const ContactControlSettings& settings,
                        const Sensing& sensing) {
  const Detection detection{
      builder.add<MomentumObserver>("momentum_observer", robot, settings.momentum_observer),
      builder.add<ContactDetector>("contact_detector", robot, settings.contact_detector)};
  builder.connect(sensing.pose.platform, detection.observer.platform);
  builder.connect(sensing.model.kinematics, detection.observer.kinematics);
  builder.connect(sensing.model.dynamics, detection.observer.dynamics);
  builder.connect(sensing.torque.torque, detection.observer.torque);
  builder.connect(detection.observer.wrench, detection.detector.wrench);
  return detection;
}

Reaction add_reaction(DiagramBuilder& builder, const Robot& robot, const ContactControlSettings& settings,
                      const Sensing& sensing, const Detection& detection) {
  const Reaction reaction{builder.add<OperatorButtons>("operator_buttons"),
                          builder.add<ReactionSequence>("reaction_sequence", settings.sequence),
                          builder.add<PlatformTrajectory>("trajectory", robot, settings.trajectory),
                          builder.add<Retraction>("retraction", robot, settings.retraction)};
  builder.connect(reaction.buttons.reset, detection.detector.reset);
  builder.connect(reaction.buttons.reset, reaction.sequence.reset);
  builder.connect(detection.detector.contact, reaction.sequence.detection);
  builder.connect(sensing.velocity.motion, reaction.sequence.joints);
  builder.connect(reaction.retraction.reference, reaction.sequence.reaction);

  builder.connect(reaction.sequence.reaction_state, reaction.trajectory.reaction);
  builder.connect(sensing.pose.platform, reaction.trajectory.platform);
  builder.connect(reaction.buttons.start, reaction.trajectory.start);

  builder.connect(reaction.sequence.reaction_state, reaction.retraction.reaction);
  builder.connect(sensing.pose.platform, reaction.retraction.platform);
  builder.connect(detection.observer.wrench, reaction.retraction.estimate);
  return reaction;
}

ImpedanceSettings softened(const ImpedanceSettings& nominal, double share, const ConfigurationSpace& space) {
  if (!(share >= 0.0 && share <= 1.0)) throw SetupError("reaction_stiffness must be between 0 and 1");
  ImpedanceSettings settings = complete(nominal, space);
  const int translations = space.translations();
  if (settings.stiffness.size() >= translations) settings.stiffness.head(translations) *= share;
  return settings;
}

Laws add_laws(DiagramBuilder& builder, const Robot& robot, const ContactControlSettings& settings,
              const Sensing& sensing, const Reaction& reaction) {
  const ImpedanceSettings soft = softened(settings.impedance, settings.reaction_stiffness, robot->space());
  const Laws laws{builder.add<ImpedanceController>("nominal_impedance", robot, settings.impedance),
                  builder.add<ImpedanceController>("reaction_impedance", robot, soft),
                  builder.add<ZeroGravity>("zero_gravity"),
                  builder.add<ControlledStop>("controlled_stop", robot, settings.controlled_stop),
                  builder.add<ModeSelector>("mode_selector", settings.modes)};
  for (ImpedanceController* impedance : {&laws.nominal, &laws.reaction}) {
    builder.connect(sensing.model.kinematics, impedance->kinematics);
    builder.connect(sensing.model.dynamics, impedance->dynamics);
  }
  builder.connect(reaction.trajectory.reference, laws.nominal.reference);
  builder.connect(reaction.retraction.reference, laws.reaction.reference);
  builder.connect(sensing.model.kinematics, laws.zero_gravity.kinematics);
  builder.connect(sensing.model.dynamics, laws.zero_gravity.dynamics);
  builder.connect(laws.zero_gravity.torque, laws.stop.zero_gravity);
  builder.connect(sensing.velocity.motion, laws.stop.joints);

  builder.connect(reaction.sequence.reaction_state, laws.selector.reaction);
  builder.connect(laws.nominal.torque, laws.selector.nominal);
  builder.connect(laws.reaction.torque, laws.selector.reacting);
  builder.connect(laws.zero_gravity.torque, laws.selector.zero_gravity);
  builder.connect(reaction.trajectory.reference, laws.selector.nominal_reference);
  builder.connect(reaction.retraction.reference, laws.selector.reaction_reference);
  return laws;
}

Safety add_safety(DiagramBuilder& builder, const Robot& robot, const ContactControlSettings& settings,
                  const Sensing& sensing, const Detection& detection, const Reaction& reaction,
                  const Laws& laws) {
  const Safety safety{builder.add<FaultMonitor>("fault_monitor", robot, settings.faults),
                      builder.add<TorqueGate>("torque_gate", settings.torque_gate)};
  builder.connect(sensing.velocity.motion, safety.monitor.motion);
  builder.connect(sensing.pose.platform, safety.monitor.platform);
  builder.connect(sensing.model.measures, safety.monitor.measures);
  builder.connect(detection.detector.contact, safety.monitor.detection);
  builder.connect(laws.selector.reference, safety.monitor.reference);
  builder.connect(laws.selector.torque, safety.monitor.command);

  builder.connect(safety.monitor.faults, safety.gate.faults);
  builder.connect(laws.selector.torque, safety.gate.command);
  builder.connect(laws.stop.torque, safety.gate.stop);
  builder.connect(reaction.buttons.reset, safety.gate.reset);
  builder.connect(safety.gate.status, reaction.sequence.gate);
  return safety;
}

}  // namespace

ContactControl add_contact_control(DiagramBuilder& outer, const Robot& robot,
                                   const ContactControlSettings& settings) {
  DiagramBuilder builder("control");
  const Sensing sensing = add_sensing(builder, robot, settings);
  const Detection detection = add_detection(builder, robot, settings, sensing);
  const Reaction reaction = add_reaction(builder, robot, settings, sensing, detection);
  const Laws laws = add_laws(builder, robot, settings, sensing, reaction);
  const Safety safety = add_safety(builder, robot, settings, sensing, detection, reaction, laws);

  const auto joints = builder.export_input("joints", sensing.velocity.joints);
  builder.connect(joints, sensing.pose.joints);
  builder.connect(joints, safety.monitor.joints);
  const auto drives = builder.export_input("drives", sensing.torque.drives);
  builder.connect(drives, safety.monitor.drives);
  const auto buttons = builder.export_input("operator_command", reaction.buttons.buttons);
  builder.connect(buttons, safety.monitor.buttons);
  const ContactControl control{
      .joints = joints,
      .drives = drives,
      .status = builder.export_input("status", safety.monitor.station),
      .operator_command = buttons,
      .tick_timing = builder.export_input("tick_timing", safety.monitor.timing),
      .torque_command = builder.export_output("torque_command", safety.gate.torque_command),
      .brake = builder.export_output("brake", safety.gate.brake),
      .joint_motion = builder.export_output("joint_motion", sensing.velocity.motion),
      .platform_motion = builder.export_output("platform_motion", sensing.pose.platform),
      .measures = builder.export_output("measures", sensing.model.measures),
      .drive_torque = builder.export_output("drive_torque", sensing.torque.torque),
      .wrench_estimate = builder.export_output("wrench_estimate", detection.observer.wrench),
      .detection = builder.export_output("detection", detection.detector.contact),
      .reaction_state = builder.export_output("reaction_state", reaction.sequence.reaction_state),
      .reference = builder.export_output("reference", laws.selector.reference),
      .nominal_wrench = builder.export_output("nominal_wrench", laws.nominal.wrench),
      .reaction_wrench = builder.export_output("reaction_wrench", laws.reaction.wrench),
      .requested_torque = builder.export_output("requested_torque", laws.selector.torque),
      .faults = builder.export_output("faults", safety.monitor.faults),
      .gate = builder.export_output("gate", safety.gate.status)};
  outer.add(builder.build());
  return control;
}

void connect(DiagramBuilder& builder, const Station& station, const ContactControl& control) {
  builder.connect(station.joints, control.joints);
  builder.connect(station.drives, control.drives);
  builder.connect(station.status, control.status);
  builder.connect(control.torque_command, station.torque_command);
  builder.connect(control.brake, station.brake);
}

}  // namespace flinch
