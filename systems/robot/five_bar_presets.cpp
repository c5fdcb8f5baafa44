#include "systems/robot/five_bar_presets.h"

namespace flinch {

FiveBarParameters five_bar_robot(FiveBarElbows elbows, FiveBarFriction friction) {
  FiveBarParameters robot;
  for (FiveBarLeg& leg : robot.legs) {
    leg.link1_length = 0.23;
    leg.link2_length = 0.23;
    leg.inertia = base_parameters(five_bar_link1(), five_bar_link2(), leg.link1_length);
    if (friction == FiveBarFriction::none) continue;
    leg.active_friction = {.viscous = 0.01, .coulomb = 0.05};
    leg.passive_friction = {.viscous = 0.002};
  }
  robot.legs[0].base_joint = {-0.1375, 0.0};
  robot.legs[1].base_joint = {0.1375, 0.0};
  robot.legs[0].elbow_sign = elbows == FiveBarElbows::outward ? -1 : 1;
  robot.legs[1].elbow_sign = elbows == FiveBarElbows::outward ? 1 : -1;
  robot.platform_mass = 0.25;
  robot.platform_radius = 0.02;
  robot.link_radius = 0.02;
  robot.home_pose = {0.0, 0.33};
  return robot;
}

LinkBody five_bar_link1() { return {.mass = 0.45, .centre_of_mass = 0.10, .inertia = 0.0026}; }

LinkBody five_bar_link2() { return {.mass = 0.18, .centre_of_mass = 0.115, .inertia = 0.0011}; }

}  // namespace flinch
