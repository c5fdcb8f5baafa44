#include "tests/systems/robot/mechanism_cases.h"

#include <cmath>
#include <numbers>

#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "tests/systems/robot/constrained_bodies.h"
#include "tests/systems/robot/legs_cases.h"
#include "tests/systems/robot/planar_cases.h"

namespace flinch::test {
namespace {

using Vector = Eigen::Vector3d;

Eigen::Matrix3d axes_of(const Configuration& pose) {
  return Eigen::Quaterniond(pose[3], pose[4], pose[5], pose[6]).toRotationMatrix();
}

double friction(const JointFriction& joint, double rate) {
  return joint.viscous * rate + joint.coulomb * std::tanh(rate / 0.01);
}

// Cylinder and rod of leg i: universal, prismatic and spherical joint.
void add_leg(ConstrainedBodies& model, const HexapodParameters& p, const HexapodLeg& leg,
             const Vector& platform_joint) {
  const Vector s = (platform_joint - leg.base_joint).normalized();
  const Vector second = leg.universal_axis.cross(s).normalized();
  Eigen::Matrix3d R;
  R << second.cross(s), second, s;
  const auto add = [&](const RigidBodyInertia& body, const Vector& origin) {
    return model.add_body(body.mass, origin + R * body.centre_of_mass, R * body.inertia * R.transpose());
  };
  const int cylinder = add(scaled(p.cylinder, leg.mass_scale), leg.base_joint);
  const int rod = add(scaled(p.rod, leg.mass_scale), platform_joint);
  model.ball(ConstrainedBodies::base, cylinder, leg.base_joint);
  model.perpendicular(ConstrainedBodies::base, leg.universal_axis, cylinder, second);
  model.slider(cylinder, rod, s, leg.base_joint, platform_joint);
  model.ball(rod, 0, platform_joint);
  model.screw(ConstrainedBodies::base, leg.base_joint, rod, platform_joint, p.drive_armature);
}

void load_leg(ConstrainedBodies& model, const HexapodLeg& leg, const Vector& platform_joint, int cylinder,
              double force) {
  const int rod = cylinder + 1;
  const Vector s = (platform_joint - leg.base_joint).normalized();
  const Vector k = leg.universal_axis;
  const Vector second = k.cross(s).normalized();
  const Vector omega = model.angular_velocity(cylinder);
  // omega = first k + second e_2 has the component along s that the joint enforces.
  const Vector across = second.cross(k);
  EXPECT_NEAR(omega.dot(across), 0.0, 1e-12);
  model.turn(cylinder, -friction(leg.universal_friction, omega.dot(k)) * k -
                           friction(leg.universal_friction, omega.dot(second)) * second);
  const double rate = s.dot(model.velocity(rod, platform_joint));
  const Vector along = (force - friction(leg.drive_friction, rate)) * s;
  model.push(rod, platform_joint, along);
  model.push(cylinder, platform_joint, -along);
}

MechanismCase hexapod_case(const std::string& name, const HexapodParameters& p) {
  const RigidBodyInertia platform = p.payload ? together(p.platform, *p.payload) : p.platform;
  std::vector<RigidBodyInertia> bodies = {platform};
  for (const HexapodLeg& leg : p.legs) {
    bodies.insert(bodies.end(), {scaled(p.cylinder, leg.mass_scale), scaled(p.rod, leg.mass_scale)});
  }

  const auto reference = [p](const MotionState& state, const Loads& loads) {
    const Eigen::Matrix3d R = axes_of(state.pose);
    const Vector origin = state.pose.head<3>();
    const auto add = [&](ConstrainedBodies& model, const RigidBodyInertia& body) {
      return model.add_body(body.mass, origin + R * body.centre_of_mass, R * body.inertia * R.transpose());
    };
    ConstrainedBodies model;
    add(model, p.platform);
    const auto platform_joint = [&](const HexapodLeg& leg) { return origin + R * leg.platform_joint; };
    for (const HexapodLeg& leg : p.legs) add_leg(model, p, leg, platform_joint(leg));
    if (p.payload) {  // the last body, on three ball joints
      const int payload = add(model, *p.payload);
      model.ball(0, payload, origin);
      model.same_axes(0, payload);
    }
    const Vector velocity = state.velocity.head<3>();
    EXPECT_LT(model.set_velocity(0, origin, velocity, state.velocity.tail<3>()), 1e-12);
    for (int i = 0; i < 6; ++i) {
      const HexapodLeg& leg = p.legs[static_cast<std::size_t>(i)];
      load_leg(model, leg, platform_joint(leg), BodyId::link1(i).index(), loads.drives[i]);
    }
    model.push(0, origin, loads.wrench.head<3>());
    model.turn(0, loads.wrench.tail<3>());
    for (const Push& push : loads.pushes) model.push(push.body.index(), push.point, push.force);
    model.set_gravity(p.gravity);
    model.solve();
    PlatformVector acceleration(6);
    acceleration << model.acceleration(0, origin), model.angular_acceleration(0);
    return acceleration;
  };
  const Eigen::Matrix<double, 6, 1> region{0.10, 0.10, 0.08, 0.25, 0.25, 0.25};
  const Eigen::Matrix<double, 6, 1> velocity{0.6, 0.6, 0.6, 3.0, 3.0, 3.0};
  return {.name = name,
          .robot = std::make_shared<const Hexapod>(p),
          .region = region,
          .velocity = velocity,
          .bodies = bodies,
          .armature = p.drive_armature,
          .reference = reference,
          .tolerances = {}};
}

// An uneven hexapod: every field differs from zero, gravity too is askew.
HexapodParameters uneven_hexapod() {
  HexapodParameters p = hexapod_robot(HexapodPayload::eccentric, HexapodFriction::ball_screws);
  for (std::size_t i = 0; i < 6; ++i) {
    const double more = 0.01 * static_cast<double>(i);
    p.legs[i].base_joint += Vector(more, -0.5 * more, 0.3 * more);
    p.legs[i].platform_joint += Vector(-0.2 * more, 0.3 * more, 0.4 * more);
    p.legs[i].universal_axis = (p.legs[i].universal_axis + Vector(0.0, more, -2.0 * more)).normalized();
    p.legs[i].mass_scale = 1.0 + 2.0 * more;
    p.legs[i].drive_friction.viscous *= 1.0 + 10.0 * more;
    p.legs[i].drive_friction.coulomb *= 1.0 - 5.0 * more;
    p.legs[i].universal_friction = {.viscous = 0.05 + more, .coulomb = 0.02 + more};
  }
  p.cylinder.centre_of_mass = {0.01, -0.02, 0.20};
  p.cylinder.inertia << 0.030, 0.001, 0.002, 0.001, 0.028, -0.001, 0.002, -0.001, 0.0056;
  p.rod.centre_of_mass = {-0.005, 0.004, -0.22};
  p.drive_armature = 3.0;
  p.gravity = {1.0, -0.5, -9.7};
  return p;
}

std::vector<MechanismCase> own_cases() {
  return {planar_rrr_case("PlanarRrrIndividual", RigGeometry::individual),
          planar_rrr_case("PlanarRrrNominal", RigGeometry::nominal),
          five_bar_case("FiveBarElbowsOutward", FiveBarElbows::outward),
          five_bar_case("FiveBarElbowsInward", FiveBarElbows::inward),
          point_on_three_legs_case("PointOnThreeLegs"),
          hexapod_case("Hexapod", hexapod_robot()),
          hexapod_case("HexapodWithPayload",
                       hexapod_robot(HexapodPayload::eccentric, HexapodFriction::ball_screws)),
          hexapod_case("HexapodUneven", uneven_hexapod())};
}

}  // namespace

const std::vector<MechanismCase>& mechanism_cases() {
  static const std::vector<MechanismCase> cases = [] {
    std::vector<MechanismCase> all = own_cases();
    for (MechanismCase& one : legs_cases()) all.push_back(std::move(one));
    return all;
  }();
  return cases;
}

}  // namespace flinch::test
