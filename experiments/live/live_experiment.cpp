#include "experiments/live/live_experiment.h"

#include "diagrams/operator_ports.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/scenario/scenario.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "systems/motion/pose_motion.h"

namespace flinch {

LiveExperiment build_live_experiment(const Scenario& scenario, RobotOutside robot) {
  const bool lockstep = robot == RobotOutside::lockstep;
  if (!scenario.operator_script.events.empty() && !lockstep) {
    throw SetupError(
        "'operator' resets and starts the robot though nobody sees what is near it; a real robot is reset by "
        "hand, as 'flinch run --attended' lets you. Leave it out, or run the scenario with the simulated "
        "station");
  }
  DiagramBuilder builder("experiment", scenario.control_period);
  LiveExperiment experiment;
  const bool has_instrument = !scenario.obstacles.empty() || !scenario.mountings.empty();
  experiment.station = add_external_station(builder, scenario.robot.robot,
                                            {.max_age = longest_age(scenario.control_period),
                                             .force_torque = has_instrument,
                                             .lockstep = lockstep});
  experiment.control = add_contact_control(builder, scenario.robot.robot, scenario.control);
  connect(builder, experiment.station, experiment.control);
  const OperatorPorts panel = add_operator(builder, experiment.control, scenario.operator_script);
  experiment.operator_command = panel.buttons;
  experiment.target = panel.target;
  if (scenario.control.contact_is_told) {
    experiment.told_classification =
        builder.export_input("told_classification", experiment.control.told_classification);
    experiment.told_location = builder.export_input("told_location", experiment.control.told_location);
  }
  experiment.tick_timing = builder.export_input("tick_timing", experiment.control.tick_timing);
  export_readings(builder, experiment.station);
  export_control(builder, experiment.control);
  builder.export_output("joints_link", experiment.station.joints_link);
  builder.export_output("drives_link", experiment.station.drives_link);
  builder.export_output("imu_link", experiment.station.imu_link);
  builder.export_output("status_link", experiment.station.status_link);
  experiment.translations = scenario.robot.robot->space().translations();
  experiment.diagram = builder.build();
  return experiment;
}

Time approach_from(const Configuration& pose, const Scenario& scenario) {
  const PlatformTrajectorySettings& trajectory = scenario.control.trajectory;
  const ParallelRobot& robot = *scenario.robot.robot;
  if (!trajectory.path || !robot.space().contains(pose)) return Time::zero();
  const PoseMotion way =
      PoseMotion::plan(robot.space(), pose, PlatformVector::Zero(robot.dof()),
                       robot.difference(trajectory.path->start(), pose), trajectory.approach);
  return from_seconds(way.duration());
}

}  // namespace flinch
