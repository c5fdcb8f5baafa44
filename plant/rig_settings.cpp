#include "plant/rig_settings.h"

#include "systems/foundation/findings.h"

namespace flinch {
namespace {

void check_start(const RigSettings& settings, Findings& found) {
  const Mechanism& robot = *settings.robot;
  if (settings.initial_velocity && !usable(*settings.initial_velocity, robot.dof())) {
    found.add("initial_velocity must have " + std::to_string(robot.dof()) + " finite entries");
  }
  const Configuration pose = settings.initial_pose.value_or(robot.home_pose());
  if (!robot.space().contains(pose)) {
    found.add("initial_pose is not a pose of this robot");
    return;
  }
  Kinematics start;
  robot.kinematics(pose, PlatformVector::Zero(robot.dof()), start);
  found.require(start.reachable, "initial_pose is out of the robot's reach");
}

}  // namespace

std::vector<std::string> problems(const RigSettings& settings) {
  if (!settings.robot) return {"a bench needs a robot"};
  Findings found;
  if (settings.obstacles.size() > static_cast<std::size_t>(max_obstacles)) {
    found.add("there are " + std::to_string(settings.obstacles.size()) + " obstacles; at most " +
              std::to_string(max_obstacles) + " can be simulated");
  }
  for (const auto& obstacle : settings.obstacles)
    found.add_all(obstacle->problems(obstacle->form().name + "."));
  if (settings.link_material) found.add_all(problems(*settings.link_material, "link_material."));
  found.require(settings.torque_ripple.empty() ||
                    settings.torque_ripple.size() == static_cast<std::size_t>(settings.robot->drives()),
                "torque_ripple has " + std::to_string(settings.torque_ripple.size()) +
                    " entries; the robot has " + std::to_string(settings.robot->drives()) + " drives");
  for (const RopePull& pull : settings.pulls) {
    found.require(pull.body >= 0 && pull.body < settings.robot->body_count(),
                  "a rope pulls at a body that the robot has not");
    found.require(pull.rise >= 0s && pull.hold >= 0s && pull.fall >= 0s,
                  "the pull of a rope has a negative rise, hold or fall");
  }
  found.not_negative("brake.torque", settings.brake.torque, "Nm");
  found.positive("brake.velocity", settings.brake.velocity, "rad/s");
  found.positive("brake.give", settings.brake.give, "rad");
  found.not_negative("brake.force", settings.brake.force, "N");
  found.positive("brake.sliding_velocity", settings.brake.sliding_velocity, "m/s");
  found.positive("brake.sliding_give", settings.brake.sliding_give, "m");
  const StickingFriction& sticking = settings.sticking;
  const bool all = sticking.stiffness.size() == 0 || usable(sticking.stiffness, settings.robot->drives());
  found.require(all && (sticking.stiffness.array() > 0.0).all(),
                "sticking.stiffness needs a positive number for each drive [Nm/rad or N/m], or none at all");
  found.positive("sticking.velocity", sticking.velocity, "rad/s");
  found.positive("sticking.sliding_velocity", sticking.sliding_velocity, "m/s");
  check_start(settings, found);
  if (found.none()) {
    found.add_all(problems(settings.elastic, *settings.robot,
                           settings.initial_pose.value_or(settings.robot->home_pose())));
  }
  return found.take();
}

}  // namespace flinch
