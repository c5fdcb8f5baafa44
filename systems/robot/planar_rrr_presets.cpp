#include "systems/robot/planar_rrr_presets.h"

#include <cstddef>
#include <numbers>

namespace flinch {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double nominal_link1_length = 0.5816;
constexpr double nominal_link2_length = 0.6198;

PlanarRrrLeg leg(double base_angle_degrees, double base_radius, double coupling_angle_degrees,
                 double link1_length, double link2_length) {
  PlanarRrrLeg leg;
  leg.base_angle = base_angle_degrees * degree;
  leg.base_radius = base_radius;
  leg.coupling_angle = coupling_angle_degrees * degree;
  leg.link1_length = link1_length;
  leg.link2_length = link2_length;
  leg.inertia = {.p1 = 0.605363, .p2 = 0.0965503, .p3 = 0.1356582};
  return leg;
}

std::array<PlanarRrrLeg, 3> legs(RigGeometry geometry) {
  if (geometry == RigGeometry::individual) {
    return {leg(90.0, 0.6877, 0.0, 0.58152, 0.62002), leg(210.7631, 0.6922, 120.0, 0.58121, 0.61964),
            leg(330.4901, 0.6666, 240.0, 0.58215, 0.61975)};
  }
  return {leg(90.0, 0.6829, 0.0, nominal_link1_length, nominal_link2_length),
          leg(210.0, 0.6829, 120.0, nominal_link1_length, nominal_link2_length),
          leg(330.0, 0.6829, 240.0, nominal_link1_length, nominal_link2_length)};
}

void set_friction(RigFriction friction, std::array<PlanarRrrLeg, 3>& legs) {
  if (friction == RigFriction::simulation) {
    for (PlanarRrrLeg& leg : legs) leg.active_friction.viscous = 1.0;
  }
  if (friction != RigFriction::test_rig) return;

  // Identified with one former torque constant for all drives, and rescaled to those of today [Nm/A].
  constexpr double former = 11.3;
  constexpr std::array<double, 3> torque_constant = {6.021, 6.6116, 6.7315};
  constexpr std::array<JointFriction, 3> active = {{{0.0031, 1.0603}, {0.0013, 1.1018}, {0.0018, 0.9911}}};
  constexpr std::array<JointFriction, 3> passive = {{{0.0983, 0.0}, {0.2236, 0.0381}, {0.0586, 0.0}}};
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const double scale = torque_constant[i] / former;
    legs[i].active_friction = {active[i].viscous * scale, active[i].coulomb * scale};
    legs[i].passive_friction = passive[i];
  }
}

}  // namespace

PlanarRrrParameters rig_robot(RigGeometry geometry, RigFriction friction) {
  PlanarRrrParameters robot;
  robot.name = "planar 3-RRR bench";
  robot.legs = legs(geometry);
  set_friction(friction, robot.legs);
  robot.coupling_radius = 0.107;
  robot.platform_mass = 0.642;
  robot.platform_inertia = 0.00367513;
  robot.platform_hull_radius = 0.137;
  robot.link_radius = 0.03;
  return robot;
}

LinkBody rig_link1() {
  constexpr double mass = 2.272;
  return {.mass = mass,
          .centre_of_mass = 0.29,
          .inertia = mass * nominal_link1_length * nominal_link1_length / 12.0};
}

LinkBody rig_link2() {
  constexpr double mass = 0.75;
  return {.mass = mass,
          .centre_of_mass = 0.311,
          .inertia = mass * nominal_link2_length * nominal_link2_length / 12.0};
}

}  // namespace flinch
