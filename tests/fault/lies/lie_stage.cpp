#include "tests/fault/lies/lie_stage.h"

#include <fmt/core.h>

#include <map>
#include <mutex>
#include <stdexcept>

#include "systems/robot/parallel_robot.h"

namespace flinch::test {
namespace {

std::string left_of_the_rig(double earlier) {
  return fmt::format("pylon: {{x_mm: {}, y_mm: -20, radius_mm: 40, stiffness_N_per_m: 6000}}\n",
                     -175.0 + earlier);
}

std::string beyond_the_tool_point(double earlier) {
  return fmt::format("pylon: {{x_mm: 0, y_mm: {}, radius_mm: 20, stiffness_N_per_m: 6000}}\n",
                     370.0 - earlier);
}

std::string beside_the_platform(double earlier) {
  return fmt::format(
      "obstacles: [{{name: ball, shape: sphere, x_mm: {}, y_mm: 0, z_mm: 640, radius_mm: 60, "
      "stiffness_N_per_m: 6000}}]\n",
      340.0 - earlier);
}

/// As hexapod_collision_realistic.yaml has it.
constexpr const char* control_of_hexapod =
    "control:\n"
    "  momentum_observer: {gain_per_s: [20, 20, 20, 20, 20, 20]}\n"
    "  impedance: {translational_stiffness_N_per_mm: [20, 20, 20], "
    "rotational_stiffness_Nm_per_rad: [2000, 2000, 2000]}\n"
    "  contact_detector: {reaction_force_N: [64, 59, 160], reaction_moment_Nm: [25, 34, 19], hard_force_N: "
    "2000, "
    "hard_moment_Nm: 500}\n";

LieStage stage_of(const std::string& robot) {
  if (robot == "planar_3rrr") return {{}, {}, 20.0, 2000.0, 0.05, 180.0, left_of_the_rig, {}};
  if (robot == "five_bar") return {{}, {}, 12.0, 600.0, 0.02, 90.0, beyond_the_tool_point, {}};
  if (robot == "hexapod_6ups")
    return {{}, {}, 8.0, 400.0, 0.03, 0.0, beside_the_platform, control_of_hexapod};
  throw std::invalid_argument("no lies are told to " + robot);
}

LieStage make_lie_stage(const std::string& robot) {
  const auto file = [](const std::string& name) {
    return FLINCH_SOURCE_DIR "/apps/robots/" + name + ".yaml";
  };
  LieStage stage = stage_of(robot);
  stage.file = file(robot);
  stage.robot = read_robot_file(stage.file);
  if (robot == "planar_3rrr") return stage;
  const DriveParameters& drives = stage.robot.drives;
  const DriveParameters rig = read_robot_file(file("planar_3rrr")).drives;
  stage.angle = drives.max_speed / rig.max_speed;
  stage.torque = drives.max_torque / rig.max_torque;
  stage.current = stage.torque * rig.torque_constant[0] / drives.torque_constant[0];
  return stage;
}

}  // namespace

const LieStage& lie_stage(const std::string& robot) {
  static std::mutex mutex;
  static std::map<std::string, LieStage> stages;
  const std::lock_guard lock(mutex);
  const auto known = stages.find(robot);
  return known != stages.end() ? known->second : stages.emplace(robot, make_lie_stage(robot)).first->second;
}

}  // namespace flinch::test
