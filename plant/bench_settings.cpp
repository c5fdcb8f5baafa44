#include "plant/bench_settings.h"

#include "plant/setting_problems.h"

namespace flinch {
namespace {

void check_start(const BenchSettings& settings, std::vector<std::string>& found) {
  const Mechanism& robot = *settings.robot;
  if (settings.initial_velocity && !usable(*settings.initial_velocity, robot.dof())) {
    found.emplace_back("initial_velocity must have " + std::to_string(robot.dof()) + " finite entries");
  }
  const Configuration pose = settings.initial_pose.value_or(robot.home_pose());
  if (!robot.space().contains(pose)) {
    found.emplace_back("initial_pose is not a pose of this robot");
    return;
  }
  Kinematics start;
  robot.kinematics(pose, PlatformVector::Zero(robot.dof()), start);
  if (!start.reachable) found.emplace_back("initial_pose is out of the robot's reach");
}

}  // namespace

std::vector<std::string> problems(const BenchSettings& settings) {
  if (!settings.robot) return {"a bench needs a robot"};
  std::vector<std::string> found;
  const auto add = [&found](std::vector<std::string> more) {
    for (std::string& problem : more) found.push_back(std::move(problem));
  };
  if (settings.obstacles.size() > static_cast<std::size_t>(max_obstacles)) {
    found.push_back("there are " + std::to_string(settings.obstacles.size()) + " obstacles; at most " +
                    std::to_string(max_obstacles) + " can be simulated");
  }
  for (const auto& obstacle : settings.obstacles) add(obstacle->problems(obstacle->form().name + "."));
  if (settings.link_material) add(problems(*settings.link_material, "link_material."));
  if (!settings.uneven_torque.empty() &&
      settings.uneven_torque.size() != static_cast<std::size_t>(settings.robot->drives())) {
    found.push_back("uneven_torque has " + std::to_string(settings.uneven_torque.size()) +
                    " entries; the robot has " + std::to_string(settings.robot->drives()) + " drives");
  }
  SettingProblems brake("brake.");
  brake.require_not_negative("torque", settings.brake.torque);
  brake.require_positive("velocity", settings.brake.velocity);
  brake.require_not_negative("force", settings.brake.force);
  brake.require_positive("sliding_velocity", settings.brake.sliding_velocity);
  brake.append_to(found);
  check_start(settings, found);
  return found;
}

}  // namespace flinch
