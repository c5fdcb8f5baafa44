#include "tests/systems/robot/planar_cases.h"

#include <array>
#include <cmath>
#include <utility>

#include "apps/examples/08_own_mechanism/point_on_three_legs.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/planar_rrr.h"
#include "tests/systems/robot/constrained_bodies.h"

namespace flinch::test {
namespace {

using Vector = Eigen::Vector3d;
const Vector up = Vector::UnitZ();

Vector at_angle(double angle) { return {std::cos(angle), std::sin(angle), 0.0}; }

// Out of the plane a body does not move, so that only its inertia about z matters.
RigidBodyInertia rigid(const LinkBody& link, double rotor = 0.0) {
  const double inertia = link.inertia + rotor;
  return {.mass = link.mass,
          .centre_of_mass = {link.centre_of_mass, 0.0, 0.0},
          .inertia = Vector(inertia, inertia, inertia).asDiagonal()};
}

// A leg between two joints, its angles by the law of cosines.
struct ReferenceLegOfBodies {
  PlanarLegParameters parameters;
  Vector base, coupling;
  double friction_velocity;

  double first_angle() const {
    const Vector w = coupling - base;
    const double l1 = parameters.link1_length;
    const double l2 = parameters.link2_length;
    const double rho = w.norm();
    const double eta = std::acos((l1 * l1 + rho * rho - l2 * l2) / (2.0 * l1 * rho));
    return std::atan2(w.y(), w.x()) - parameters.elbow_sign * eta;
  }
  Vector elbow() const { return base + parameters.link1_length * at_angle(first_angle()); }
};

double friction(const JointFriction& joint, double rate, double velocity) {
  return joint.viscous * rate + joint.coulomb * std::tanh(rate / velocity);
}

// Bodies 1 + 2 i and 2 + 2 i of a robot: links along their x axes.
void add_links(ConstrainedBodies& model, const ReferenceLegOfBodies& leg, const RigidBodyInertia& link1,
               const RigidBodyInertia& link2) {
  const Vector elbow = leg.elbow();
  const auto add = [&](const RigidBodyInertia& link, const Vector& from, const Vector& to) {
    const double angle = std::atan2(to.y() - from.y(), to.x() - from.x());
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, up).toRotationMatrix();
    return model.add_body(link.mass, from + R * link.centre_of_mass, R * link.inertia * R.transpose());
  };
  const int first = add(link1, leg.base, elbow);
  const int second = add(link2, elbow, leg.coupling);
  model.revolute(ConstrainedBodies::base, first, leg.base, up);
  model.revolute(first, second, elbow, up);
}

void load_leg(ConstrainedBodies& model, int i, const ReferenceLegOfBodies& leg, double torque) {
  const int first = BodyId::link1(i).index();
  const int second = BodyId::link2(i).index();
  const double active = model.angular_velocity(first).z();
  const double passive = model.angular_velocity(second).z() - active;
  const double at_elbow = friction(leg.parameters.passive_friction, passive, leg.friction_velocity);
  const double at_base = friction(leg.parameters.active_friction, active, leg.friction_velocity);
  model.turn(first, (torque - at_base + at_elbow) * up);
  model.turn(second, -at_elbow * up);
}

void push(ConstrainedBodies& model, const std::vector<Push>& pushes) {
  for (const Push& push : pushes) model.push(push.body.index(), push.point, push.force);
}

// Different inertia, rotor and friction in every leg, so that no symmetry hides a mistake.
void make_uneven(std::size_t i, const LinkBody& link1, const LinkBody& link2, PlanarLegParameters& leg,
                 std::vector<RigidBodyInertia>& bodies) {
  const double more = 0.15 * static_cast<double>(i);
  const LinkBody first{link1.mass * (1.0 + more), link1.centre_of_mass * (1.0 + 0.2 * more), link1.inertia};
  const LinkBody second{link2.mass / (1.0 + more), link2.centre_of_mass * (1.0 - 0.4 * more), link2.inertia};
  leg.inertia = base_parameters(first, second, leg.link1_length);
  leg.rotor_inertia = 0.1 * link1.inertia * (1.0 + more);
  leg.active_friction = {.viscous = 0.02, .coulomb = 0.1 * (1.0 + more)};
  leg.passive_friction = {.viscous = 0.01, .coulomb = 0.02 * (1.0 + more)};
  bodies.push_back(rigid(first, leg.rotor_inertia));
  bodies.push_back(rigid(second));
}

// The platform and the links of all legs, which are made uneven.
template <class Leg, std::size_t count>
std::vector<RigidBodyInertia> platform_and_links(const LinkBody& platform, const LinkBody& link1,
                                                 const LinkBody& link2, std::array<Leg, count>& legs) {
  std::vector<RigidBodyInertia> bodies = {rigid(platform)};
  for (std::size_t i = 0; i < count; ++i) make_uneven(i, link1, link2, legs[i], bodies);
  return bodies;
}

// Of a robot whose legs meet in a point, where inertia of the platform has no effect.
template <std::size_t count>
std::vector<RigidBodyInertia> point_and_links(double mass, std::array<FiveBarLeg, count>& legs) {
  return platform_and_links({.mass = mass, .inertia = 1.0}, five_bar_link1(), five_bar_link2(), legs);
}

// A robot whose legs meet in a point.
MechanismCase point_case(const std::string& name, std::shared_ptr<const ParallelRobot> robot,
                         const std::vector<FiveBarLeg>& robot_legs,
                         const std::vector<RigidBodyInertia>& bodies) {
  const Vector gravity = robot->gravity();
  const auto reference = [robot_legs, bodies, gravity](const MotionState& state, const Loads& loads) {
    constexpr double friction_velocity = 0.01;  // [rad/s]
    const Vector point(state.pose[0], state.pose[1], 0.0);
    ConstrainedBodies model;
    model.add_body(bodies[0].mass, point, bodies[0].inertia);
    model.same_axes(ConstrainedBodies::base, 0);  // A point mass does not turn.
    std::vector<ReferenceLegOfBodies> legs;
    for (std::size_t i = 0; i < robot_legs.size(); ++i) {
      const FiveBarLeg& leg = robot_legs[i];
      legs.push_back({leg, Vector(leg.base_joint.x(), leg.base_joint.y(), 0.0), point, friction_velocity});
      add_links(model, legs[i], bodies[1 + 2 * i], bodies[2 + 2 * i]);
      model.ball(static_cast<int>(2 + 2 * i), 0, point);
    }
    const Vector velocity(state.velocity[0], state.velocity[1], 0.0);
    EXPECT_LT(model.set_velocity(0, point, velocity, Vector::Zero()), 1e-12);
    for (std::size_t i = 0; i < legs.size(); ++i) {
      const int leg = static_cast<int>(i);
      load_leg(model, leg, legs[i], loads.drives[leg]);
    }
    model.push(0, point, {loads.wrench[0], loads.wrench[1], 0.0});
    push(model, loads.pushes);
    model.set_gravity(gravity);
    model.solve();
    return PlatformVector(model.acceleration(0, point).head<2>());
  };
  return {.name = name,
          .robot = std::move(robot),
          .region = Eigen::Vector2d(0.09, 0.055),
          .velocity = Eigen::Vector2d(0.6, 0.6),
          .bodies = bodies,
          .reference = reference,
          .tolerances = {.step = 1e-4,
                         .drive_map = 2e-10,
                         .drive_map_rate = 2e-9,
                         .contact = 4e-9,
                         .contact_rate = 2e-9,
                         .mass_rate = 2e-9,
                         .momentum = 1e-7}};
}

}  // namespace

MechanismCase planar_rrr_case(const std::string& name, RigGeometry geometry) {
  PlanarRrrParameters parameters = rig_robot(geometry, RigFriction::none);
  const std::vector<RigidBodyInertia> bodies =
      platform_and_links({.mass = parameters.platform_mass, .inertia = parameters.platform_inertia},
                         rig_link1(), rig_link2(), parameters.legs);
  const auto reference = [parameters, bodies](const MotionState& state, const Loads& loads) {
    const Vector origin(state.pose[0], state.pose[1], 0.0);
    ConstrainedBodies model;
    model.add_body(bodies[0].mass, origin, bodies[0].inertia);
    std::vector<ReferenceLegOfBodies> legs;
    for (std::size_t i = 0; i < 3; ++i) {
      const PlanarRrrLeg& leg = parameters.legs[i];
      const double r = leg.base_radius;
      legs.push_back({leg, Vector(r * std::sin(leg.base_angle), -r * std::cos(leg.base_angle), 0.0),
                      origin + parameters.coupling_radius * at_angle(state.pose[2] + leg.coupling_angle),
                      parameters.friction_velocity});
      add_links(model, legs[i], bodies[1 + 2 * i], bodies[2 + 2 * i]);
      model.revolute(static_cast<int>(2 + 2 * i), 0, legs[i].coupling, up);
    }
    const Eigen::Vector3d v = state.velocity;
    EXPECT_LT(model.set_velocity(0, origin, {v.x(), v.y(), 0.0}, v.z() * up), 1e-12);
    for (int i = 0; i < 3; ++i) load_leg(model, i, legs[static_cast<std::size_t>(i)], loads.drives[i]);
    model.push(0, origin, {loads.wrench[0], loads.wrench[1], 0.0});
    model.turn(0, loads.wrench[2] * up);
    push(model, loads.pushes);
    model.set_gravity(parameters.gravity);
    model.solve();
    const Vector a = model.acceleration(0, origin);
    return PlatformVector(Eigen::Vector3d(a.x(), a.y(), model.angular_acceleration(0).z()));
  };
  return {.name = name,
          .robot = std::make_shared<const PlanarRrr>(parameters),
          .region = Eigen::Vector3d(0.25, 0.25, 0.61),
          .velocity = Eigen::Vector3d(1.0, 1.0, 3.0),
          .least_det_A = 0.2,
          .bodies = bodies,
          .reference = reference,
          .tolerances = {.drive_map = 2e-9,
                         .drive_map_rate = 3e-9,
                         .contact = 5e-10,
                         .contact_rate = 1e-9,
                         .mass_rate = 3e-9,
                         .momentum = 3e-9}};
}

MechanismCase five_bar_case(const std::string& name, FiveBarElbows elbows) {
  FiveBarParameters parameters = five_bar_robot(elbows);
  const std::vector<RigidBodyInertia> bodies = point_and_links(parameters.platform_mass, parameters.legs);
  const std::vector<FiveBarLeg> legs(parameters.legs.begin(), parameters.legs.end());
  return point_case(name, std::make_shared<const FiveBar>(parameters), legs, bodies);
}

MechanismCase point_on_three_legs_case(const std::string& name) {
  PointOnThreeLegs::Parameters parameters = point_on_three_legs();
  const std::vector<RigidBodyInertia> bodies = point_and_links(parameters.platform_mass, parameters.legs);
  const std::vector<FiveBarLeg> legs(parameters.legs.begin(), parameters.legs.end());
  return point_case(name, std::make_shared<const PointOnThreeLegs>(parameters), legs, bodies);
}

}  // namespace flinch::test
