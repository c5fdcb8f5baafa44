// All stages wired by hand, from encoders and IMU to torques. The second link of leg 1 runs into a post:
//
//   encoders -> velocity filter -> forward kinematics -> model -> momentum observer -> detector -> classifier
//   -> particle filter -> task of the reaction -> task controller -> mode selector -> torque gate -> drives
//   IMU -> extended Kalman filter -> direct method: the same wrench, sooner
//
// Nothing watches for faults here: beside a real robot, add_contact_control() wires that as well. Start it in
// the root of the tree.
#include <flinch/framework.h>
#include <flinch/plant.h>
#include <flinch/simulated_experiments.h>
#include <flinch/systems.h>
#include <cstdio>

using namespace flinch;

/// The blocks, and how they are wired.
struct SevenStages {
  DiagramBuilder& builder;
  const SimulatedScenario& scenario;
  const ContactControlSettings& set = scenario.control;
  const IsolationSettings& where = set.isolation;
  std::shared_ptr<const ParallelRobot> robot = scenario.robot.robot;

  VelocityFilter& velocity = builder.add<VelocityFilter>("velocity", robot, set.velocity_filter);
  ForwardKinematics& pose = builder.add<ForwardKinematics>("pose", robot);
  RobotModel& model = builder.add<RobotModel>("model", robot);
  DriveTorqueMapping& torque =
      builder.add<DriveTorqueMapping>("torque", robot, set.drive_torque, set.velocity_filter.low_pass);
  ImuFilter& imu = builder.add<ImuFilter>("imu", robot, set.extended_imu_ekf);
  DirectMethod& direct = builder.add<DirectMethod>("direct", robot);
  MomentumObserver& observer = builder.add<MomentumObserver>("observer", robot, set.momentum_observer);
  MomentumObserver& isolation = builder.add<MomentumObserver>("isolation", robot, quicker());
  ContactDetector& sooner = builder.add<ContactDetector>(
      "sooner", robot, ContactDetectorSettings{.reaction = {29.0, 2.2}});  // [RAL25] Table II
  ContactDetector& detector = builder.add<ContactDetector>("detector", robot, set.contact_detector);
  ContactPeriod& contact = builder.add<ContactPeriod>("contact");
  EvidenceEstimator& evidence = builder.add<EvidenceEstimator>(
      "evidence", robot, where.hypotheses, where.uncertainty, where.model_classifier.window);
  ModelClassifier& classifier = builder.add<ModelClassifier>("classifier", robot, where.model_classifier);
  WrenchTrend& trend = builder.add<WrenchTrend>("trend", 50ms);
  ParticleLocator& particles = builder.add<ParticleLocator>(
      "particles", robot, where.particle_filter, where.closed_form, where.uncertainty, scenario.seed);
  ReactionSequence& sequence = builder.add<ReactionSequence>("sequence", set.sequence);
  PlatformTrajectory& path = builder.add<PlatformTrajectory>("path", robot, set.trajectory);
  PoseGoals& nominal_task = builder.add<PoseGoals>("nominal_task", robot, set.tasks.nominal);
  ReactionTask& task = builder.add<ReactionTask>("task", robot, set.tasks.reaction, set.tasks.nominal);
  TaskController& nominal = builder.add<TaskController>("nominal", robot, TaskControllerSettings{});
  TaskController& reacting = builder.add<TaskController>("reacting", robot, TaskControllerSettings{});
  ZeroGravity& rest = builder.add<ZeroGravity>("rest");
  ControlledStop& stop = builder.add<ControlledStop>("stop", robot, set.controlled_stop);
  ModeSelector& modes = builder.add<ModeSelector>("modes", set.modes);
  TorqueGate& gate = builder.add<TorqueGate>("gate", set.torque_gate);

  /// Noise matters less to who asks what is touched.
  MomentumObserverSettings quicker() const {
    MomentumObserverSettings settings = set.momentum_observer;
    settings.gain.setConstant(where.observer_gain);
    return settings;
  }

  void connect(const SimulatedStation& station) const {
    builder.connect(station.joints, velocity.joints, pose.joints, torque.joints);
    builder.connect(station.drives, torque.drives);
    builder.connect(station.status, torque.status);
    builder.connect(station.imu, imu.imu);
    builder.connect(velocity.motion, pose.motion, sequence.joints, stop.joints);
    builder.connect(pose.platform, model.platform, imu.platform, direct.platform, observer.platform,
                    isolation.platform, path.platform);
    builder.connect(model.kinematics, direct.kinematics, observer.kinematics, isolation.kinematics,
                    evidence.kinematics, particles.kinematics, nominal_task.kinematics, task.kinematics,
                    nominal.kinematics, reacting.kinematics, rest.kinematics);
    builder.connect(model.dynamics, direct.dynamics, observer.dynamics, isolation.dynamics, task.dynamics,
                    nominal.dynamics, reacting.dynamics, rest.dynamics);
    builder.connect(torque.torque, direct.torque, observer.torque, isolation.torque);
    builder.connect(imu.acceleration, direct.acceleration);
    builder.connect(direct.wrench, sooner.wrench);
    builder.connect(observer.wrench, detector.wrench);
    builder.connect(isolation.wrench, evidence.wrench, trend.wrench, particles.wrench, task.estimate);
    builder.connect(detector.contact, contact.detection, sequence.detection);
    builder.connect(contact.phase, evidence.phase, classifier.phase, particles.phase);
    builder.connect(evidence.evidence, classifier.evidence);
    builder.connect(classifier.classification, particles.classification, task.classification);
    builder.connect(trend.change, particles.change);
    builder.connect(particles.location, task.location);
    builder.connect(sequence.reaction_state, path.reaction, task.reaction, modes.reaction);
    builder.connect(path.reference, nominal_task.reference, modes.nominal_reference);
    builder.connect(task.reference, sequence.reaction, modes.reaction_reference);
    builder.connect(nominal_task.goals, nominal.tasks);
    builder.connect(task.goals, reacting.tasks);
    builder.connect(nominal.torque, modes.nominal);
    builder.connect(reacting.torque, modes.reacting);
    builder.connect(rest.torque, modes.zero_gravity, modes.yielding, stop.zero_gravity);
    builder.connect(modes.torque, gate.command);
    builder.connect(stop.torque, gate.stop);
    builder.connect(gate.torque_command, station.torque_command, modes.commanded);
    builder.connect(gate.brake, station.brake);
    builder.connect(gate.status, sequence.gate);
    // Nobody presses a button, nothing is limited, nothing is found to be broken.
    builder.fix(ResetCommand{}, sooner.reset, detector.reset, contact.reset, sequence.reset, gate.reset);
    builder.fix(StartCommand{}, path.start);
    builder.fix(TargetCommand{}, path.target);
    builder.fix(DriveCheckStatus{}, path.drive_check);
    TaskList no_goals;
    ConstraintState unlimited;
    no_goals.valid = unlimited.valid = true;
    builder.fix(no_goals, nominal.constraint_goals, reacting.constraint_goals);
    builder.fix(unlimited, nominal.constraints, reacting.constraints);
    builder.fix(FaultReport{.valid = true}, gate.faults);
  }
};

int main() try {
  const auto scenario = read_simulated_scenario("apps/scenarios/second_link_reaction.yaml");
  DiagramBuilder builder("seven_stages");
  const SimulatedStation station = add_simulated_station(builder, scenario.station);
  const SevenStages stages{builder, scenario};
  stages.connect(station);
  const auto diagram = builder.build();

  Simulator simulator(*diagram, std::make_unique<SundialsIntegrator>());
  Context context = diagram->make_context();
  const auto say_when = [&](const char* what, const auto& happens) {
    while (context.time() < scenario.duration && !happens()) simulator.step(context);
    std::printf("%.3f s  %s\n", to_seconds(context.time()), what);
  };
  const ContactTruth& truth = context.get(station.contact_truth);
  const ContactClassification& touched = context.get(stages.classifier.classification);
  const ContactLocation& place = context.get(stages.particles.location);
  say_when("touched", [&] { return truth.in_contact; });
  say_when("detected by IMU and encoders",
           [&] { return context.get(stages.sooner.contact).level != ContactLevel::none; });
  say_when("detected by encoders alone",
           [&] { return context.get(stages.detector.contact).level != ContactLevel::none; });
  say_when("classified and placed", [&] { return touched.accepted && place.located && truth.in_contact; });
  if (!touched.accepted || !truth.in_contact) return 1;
  const std::string body =
      ContactClasses(stages.robot->body_count(), stages.robot->legs()).name(touched.most_likely);
  const double miss = (place.point_in_base - truth.strongest.point_in_base).norm();
  std::printf("         %s, %.0f mm from where it is touched\n", body.c_str(), 1e3 * miss);
  say_when("removed", [&] { return !truth.in_contact; });
  return body == "leg1_link2" && miss < 0.06 && !truth.in_contact ? 0 : 1;
} catch (const std::exception& error) {  // a SetupError says all that is wrong
  std::fprintf(stderr, "error: %s\n", error.what());
  return 2;
}
