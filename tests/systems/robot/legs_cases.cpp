#include "tests/systems/robot/legs_cases.h"

#include <cmath>

#include "systems/config/legs_file.h"
#include "systems/robot/legs/legs_robot.h"
#include "systems/robot/rotation.h"
#include "tests/systems/robot/constrained_bodies.h"

namespace flinch::test {
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

Matrix turned(const Vector& xi) { return rotation_matrix(quaternion_exp(xi)); }

Vector in_space(const CartesianVector& p) { return {p[0], p[1], p.size() == 3 ? p[2] : 0.0}; }

double friction(const JointFriction& joint, double rate) {
  return joint.viscous * rate + joint.coulomb * std::tanh(rate / 0.01);
}

/// A body and its frame at an instant.
struct Placed {
  int body = ConstrainedBodies::base;
  Vector origin = Vector::Zero();
  Matrix axes = Matrix::Identity();
};

/// A joint between two placed bodies.
struct PlacedJoint {
  const LegJoint* joint;
  Placed parent, child;
  Vector at;           ///< Of its frame on the parent.
  Vector axis;         ///< First axis, fixed to the parent.
  Vector second_axis;  ///< Fixed to the child.
};

class LegsReference {
 public:
  LegsReference(const LegsParameters& parameters, const ParallelRobot& robot)
      : parameters_(parameters), robot_(robot), follows_(parameters.moves.following() > 0) {}

  PlatformVector acceleration(const MotionState& state, const Loads& loads) {
    Kinematics k;
    robot_.kinematics(state.pose, state.velocity, k);
    const Placed platform = add(k, BodyId::platform(), parameters_.platform.inertia);
    hold_platform(platform);
    std::vector<PlacedJoint> joints;
    for (std::size_t i = 0; i < parameters_.legs.size(); ++i) add_leg(k, i, platform, joints);
    if (parameters_.payload) {
      const Placed payload = add(k, BodyId::platform(), *parameters_.payload);
      model_.ball(platform.body, payload.body, platform.origin);
      model_.same_axes(platform.body, payload.body);
    }
    const auto [velocity, angular] = twist(k);
    EXPECT_LT(model_.set_velocity(platform.body, platform.origin, velocity, angular), 1e-11);
    int drive = 0;
    for (const PlacedJoint& joint : joints) load(joint, loads, drive);
    for (const Push& push : loads.pushes)
      model_.push(bodies_[static_cast<std::size_t>(push.body.index())], push.point, push.force);
    load_platform(platform, loads.wrench);
    model_.set_gravity(parameters_.gravity);
    model_.solve();
    return platform_acceleration(platform);
  }

 private:
  const ConfigurationSpace& space() const { return robot_.description().space; }

  // Frame of a body as its points tell it.
  Placed placed(const Kinematics& k, BodyId id) const {
    const int directions = robot_.space_dimension();
    Placed body;
    body.origin = in_space(robot_.point_on_body(k, id, CartesianVector::Zero(directions)));
    for (int i = 0; i < directions; ++i) {
      body.axes.col(i) =
          in_space(robot_.point_on_body(k, id, CartesianVector::Unit(directions, i))) - body.origin;
    }
    return body;
  }

  Placed add(const Kinematics& k, BodyId id, const RigidBodyInertia& inertia) {
    Placed body = placed(k, id);
    body.body = model_.add_body(inertia.mass, body.origin + body.axes * inertia.centre_of_mass,
                                body.axes * inertia.inertia * body.axes.transpose());
    bodies_.push_back(body.body);
    return body;
  }

  // What the platform's coordinates leave out.
  void hold_platform(const Placed& platform) {
    const bool keeps_its_axes = space().rotations() == 0 && !follows_;
    if (keeps_its_axes) model_.same_axes(ConstrainedBodies::base, platform.body);
  }

  void add_leg(const Kinematics& k, std::size_t index, const Placed& platform,
               std::vector<PlacedJoint>& joints) {
    const RobotLeg& leg = parameters_.legs[index];
    Placed parent;
    parent.origin = leg.at;
    parent.axes = turned(leg.turned);
    int link = 0;
    for (const LegJoint& joint : leg.joints) {
      ASSERT_TRUE(joint.link && !joint.follows);
      const int leg_number = static_cast<int>(index);
      const BodyId id = link++ == 0 ? BodyId::link1(leg_number) : BodyId::link2(leg_number);
      RigidBodyInertia inertia = joint.link->inertia;
      const bool rotor = joint.drive && joint.kind == LegJointKind::revolute;
      if (rotor) {  // It stands on the base, so that it only turns about the axis.
        ASSERT_EQ(link, 1);
        const Vector a = joint.axis.normalized();
        inertia.inertia += joint.drive->armature * a * a.transpose();
      }
      const Placed child = add(k, id, inertia);
      const Matrix frame = parent.axes * turned(joint.turned);
      PlacedJoint placed_joint{&joint,
                               parent,
                               child,
                               parent.origin + parent.axes * joint.at,
                               frame * joint.axis.normalized(),
                               child.axes * joint.second_axis.normalized()};
      hold(placed_joint);
      joints.push_back(placed_joint);
      parent = child;
    }
    for (const LegClosure& closure : leg.closures) {
      const Vector tip = parent.origin + parent.axes * closure.at;
      EXPECT_LT((tip - platform.origin - platform.axes * closure.on_at).norm(), 1e-13);
      model_.ball(parent.body, platform.body, tip);
      if (closure.holds_frame) model_.same_axes(parent.body, platform.body);
    }
  }

  void hold(const PlacedJoint& at) {
    const bool is_slide = at.joint->kind == LegJointKind::prismatic;
    const Vector missed = at.child.origin - at.at;
    EXPECT_LT((is_slide ? Vector(missed.cross(at.axis)) : missed).norm(), 1e-13);
    if (at.joint->kind == LegJointKind::revolute) {
      const Vector of_child = at.child.axes * at.joint->axis.normalized();
      EXPECT_LT((of_child - at.axis).norm(), 1e-13);
      model_.revolute(at.parent.body, at.child.body, at.at, at.axis);
    } else if (is_slide) {
      model_.slider(at.parent.body, at.child.body, at.axis, at.at, at.child.origin);
      if (at.joint->drive && at.joint->drive->armature > 0.0)
        model_.screw(at.parent.body, at.at, at.child.body, at.child.origin, at.joint->drive->armature);
    } else {
      ASSERT_EQ(at.joint->kind, LegJointKind::universal);
      EXPECT_NEAR(at.axis.dot(at.second_axis), 0.0, 1e-13);
      model_.ball(at.parent.body, at.child.body, at.at);
      model_.perpendicular(at.parent.body, at.axis, at.child.body, at.second_axis);
    }
  }

  // The same about both axes of a universal joint, whose rates are the shares of omega = first a_1 + second
  // a_2.
  void load(const PlacedJoint& at, const Loads& loads, int& drive) {
    const LegJoint& joint = *at.joint;
    double effort = joint.drive ? loads.drives[drive++] : 0.0;
    if (joint.kind == LegJointKind::prismatic) {
      const double rate = at.axis.dot(model_.velocity(at.child.body, at.child.origin) -
                                      model_.velocity(at.parent.body, at.child.origin));
      effort -= friction(joint.friction, rate);
      model_.push(at.child.body, at.child.origin, effort * at.axis);
      if (at.parent.body != ConstrainedBodies::base)
        model_.push(at.parent.body, at.child.origin, -effort * at.axis);
      return;
    }
    const Vector omega = model_.angular_velocity(at.child.body) - model_.angular_velocity(at.parent.body);
    turn(at, (effort - friction(joint.friction, omega.dot(at.axis))) * at.axis);
    if (joint.kind == LegJointKind::universal)
      turn(at, -friction(joint.friction, omega.dot(at.second_axis)) * at.second_axis);
  }

  void turn(const PlacedJoint& at, const Vector& torque) {
    model_.turn(at.child.body, torque);
    if (at.parent.body != ConstrainedBodies::base) model_.turn(at.parent.body, -torque);
  }

  std::pair<Vector, Vector> twist(const Kinematics& k) const {
    const int t = space().translations();
    const int r = space().rotations();
    Vector velocity = Vector::Zero();
    Vector angular = Vector::Zero();
    velocity.head(t) = k.velocity.head(t);
    angular.tail(r) = k.velocity.tail(r);
    if (follows_)
      angular = robot_.contact_jacobian(k, BodyId::platform(), Vector::Zero()).rotation * k.velocity;
    return {velocity, angular};
  }

  void load_platform(const Placed& platform, const PlatformVector& wrench) {
    const int t = space().translations();
    const int r = space().rotations();
    Vector force = Vector::Zero();
    Vector moment = Vector::Zero();
    force.head(t) = wrench.head(t);
    moment.tail(r) = wrench.tail(r);
    model_.push(platform.body, platform.origin, force);
    model_.turn(platform.body, moment);
  }

  PlatformVector platform_acceleration(const Placed& platform) const {
    PlatformVector acceleration(robot_.dof());
    const int t = space().translations();
    const int r = space().rotations();
    acceleration.head(t) = model_.acceleration(platform.body, platform.origin).head(t);
    acceleration.tail(r) = model_.angular_acceleration(platform.body).tail(r);
    return acceleration;
  }

  const LegsParameters& parameters_;
  const ParallelRobot& robot_;
  bool follows_;  ///< Of its chart numbers, some follow from the others.
  ConstrainedBodies model_;
  std::vector<int> bodies_;  ///< By BodyId, the payload last.
};

// Inertia by BodyId.
std::vector<RigidBodyInertia> bodies_of_case(const LegsParameters& p) {
  std::vector<RigidBodyInertia> bodies = {p.payload ? together(p.platform.inertia, *p.payload)
                                                    : p.platform.inertia};
  for (const RobotLeg& leg : p.legs) {
    const std::size_t before = bodies.size();
    for (const LegJoint& joint : leg.joints) {
      if (joint.link) bodies.push_back(joint.link->inertia);
    }
    EXPECT_EQ(bodies.size(), before + 2);
  }
  return bodies;
}

double armature_of(const LegsParameters& p) {
  for (const LegJoint& joint : p.legs.front().joints) {
    if (joint.drive) return joint.drive->armature;
  }
  return 0.0;
}

PlatformVector vector(std::initializer_list<double> values) {
  PlatformVector v(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), v.data());
  return v;
}

}  // namespace

LegsParameters legs_parameters_of(const std::filesystem::path& file) {
  ConfigReader reader = ConfigReader::open(file);
  LegsParameters parameters = read_legs_parameters(reader);
  EXPECT_TRUE(reader.good()) << file;
  return parameters;
}

MechanismCase legs_case(const std::string& name, const LegsParameters& parameters,
                        const PlatformVector& region, const PlatformVector& velocity,
                        const Tolerances& tolerances) {
  const auto robot = std::make_shared<const LegsRobot>(parameters);
  return {.name = name,
          .robot = robot,
          .region = region,
          .velocity = velocity,
          .bodies = bodies_of_case(parameters),
          .armature = armature_of(parameters),
          .reference =
              [parameters, robot](const MotionState& state, const Loads& loads) {
                return LegsReference(parameters, *robot).acceleration(state, loads);
              },
          .tolerances = tolerances};
}

std::vector<MechanismCase> legs_cases() {
  const std::filesystem::path robots = std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/robots";
  const Tolerances widest{.step = 1e-4,
                          .drive_map = 4e-10,
                          .drive_map_rate = 2e-9,
                          .contact = 8e-9,
                          .contact_rate = 2e-9,
                          .mass_rate = 4e-9,
                          .momentum = 1e-8,
                          .gravity = 5e-10,
                          .acceleration = 1e-10};
  const auto of = [&](const char* name, const char* file, const PlatformVector& region,
                      const PlatformVector& velocity) {
    return legs_case(name, legs_parameters_of(robots / file), region, velocity, widest);
  };
  const PlatformVector pose = vector({0.06, 0.06, 0.05, 0.2, 0.2, 0.2});
  const PlatformVector twist = vector({0.6, 0.6, 0.6, 3.0, 3.0, 3.0});
  MechanismCase delta = of("LegsDelta", "delta.yaml", vector({0.15, 0.15, 0.1}), vector({1.0, 1.0, 1.0}));
  delta.least_jumps = 0;  // With the platform above, its knees are on the other side.
  MechanismCase rpr =
      of("LegsPlanar3Rpr", "planar_3rpr.yaml", vector({0.06, 0.06, 0.2}), vector({0.6, 0.6, 2.0}));
  rpr.least_jumps = 1;  // Turning it far enough takes the legs beyond their ranges.
  MechanismCase rrr =
      of("LegsPlanar4Rrr", "planar_4rrr.yaml", vector({0.2, 0.2, 0.3}), vector({0.6, 0.6, 2.0}));
  rrr.largest_disagreement = 1e-3;  // A turned platform fits all four drives to some tenths of a milliradian.
  MechanismCase tricept =
      of("LegsTricept", "tricept.yaml", vector({0.08, 0.08, 0.08}), vector({0.6, 0.6, 0.6}));
  tricept.least_jumps = 0;  // The path to where its struts would turn over is blocked.
  return {delta,
          rpr,
          rrr,
          of("LegsHexa6Rus", "hexa_6rus.yaml", pose, twist),
          of("LegsLinapod6Pus", "linapod_6pus.yaml", pose, twist),
          tricept};
}

}  // namespace flinch::test
