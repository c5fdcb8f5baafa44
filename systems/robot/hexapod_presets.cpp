#include "systems/robot/hexapod_presets.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace flinch {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

Eigen::Vector3d on_circle(double radius, double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle), 0.0};
}

RigidBodyInertia body(double mass, const Eigen::Vector3d& centre_of_mass, const Eigen::Vector3d& moments) {
  return {.mass = mass, .centre_of_mass = centre_of_mass, .inertia = moments.asDiagonal()};
}

}  // namespace

HexapodParameters hexapod_robot(HexapodPayload payload, HexapodFriction friction) {
  constexpr std::array<double, 6> base_angles = {12.0, 108.0, 132.0, 228.0, 252.0, 348.0};
  constexpr std::array<double, 6> platform_angles = {48.0, 72.0, 168.0, 192.0, 288.0, 312.0};
  const bool screws = friction == HexapodFriction::ball_screws;
  const JointFriction drive = screws ? JointFriction{.viscous = 200.0, .coulomb = 15.0} : JointFriction{};
  const JointFriction universal = screws ? JointFriction{.viscous = 0.05} : JointFriction{};
  HexapodParameters robot;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const double psi = base_angles[i] * degree;
    robot.legs[i] = {.base_joint = on_circle(0.50, psi),
                     .platform_joint = on_circle(0.25, platform_angles[i] * degree),
                     .universal_axis = {-std::sin(psi), std::cos(psi), 0.0},
                     .drive_friction = drive,
                     .universal_friction = universal};
  }
  robot.cylinder_length = 0.44;
  robot.rod_length = 0.50;
  robot.cylinder_radius = 0.035;
  robot.rod_radius = 0.020;
  robot.cylinder = body(2.0, {0.0, 0.0, 0.20}, {0.030, 0.030, 0.0016});
  robot.rod = body(0.9, {0.0, 0.0, -0.22}, {0.018, 0.018, 0.0002});
  robot.platform = body(6.0, {0.0, 0.0, 0.01}, {0.10, 0.10, 0.19});
  if (payload == HexapodPayload::eccentric) {
    robot.payload = body(5.0, {0.03, -0.02, 0.08}, {0.025, 0.030, 0.020});
  }
  robot.platform_radius = 0.28;
  robot.platform_bottom = -0.02;
  robot.platform_top = 0.04;
  robot.home_position = {0.0, 0.0, 0.62};
  robot.characteristic_length = 0.25;
  return robot;
}

}  // namespace flinch
