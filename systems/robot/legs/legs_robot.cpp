#include "systems/robot/legs/legs_robot.h"

#include <cmath>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/robot/angles.h"
#include "systems/robot/legs/home_assembly.h"
#include "systems/robot/legs/legs_assembly.h"
#include "systems/robot/legs/legs_dynamics.h"
#include "systems/robot/legs/legs_motion.h"
#include "systems/robot/robot_deviation.h"

namespace flinch {
namespace {

LegsModel sound_model(const LegsParameters& parameters) {
  AssembledLegs assembled = legs_model(parameters);
  throw_if_any(std::move(assembled.problems));
  return std::move(assembled.model);
}

std::vector<Body> bodies_of_robot(const LegsParameters& parameters) {
  std::vector<Body> bodies = {{body_name(BodyId::platform()), -1, parameters.platform.shapes}};
  for (std::size_t i = 0; i < parameters.legs.size(); ++i) {
    const auto leg = static_cast<int>(i);
    const std::vector<std::size_t> links = bodies_of(parameters.legs[i]);
    const auto shapes = [&](std::size_t k) {
      return k < links.size() ? parameters.legs[i].joints[links[k]].link->shapes : std::vector<Shape>();
    };
    bodies.push_back({body_name(BodyId::link1(leg)), leg, shapes(0)});
    bodies.push_back({body_name(BodyId::link2(leg)), leg, shapes(1)});
  }
  return bodies;
}

// Whether two bodies meet at one joint, on the base or on the platform.
bool are_neighbours(const LegsModel& model, const JointOfLeg& a, const JointOfLeg& b) {
  constexpr double same = 1e-9;  // [m]
  const LegChain& chain_a = model.legs[a.leg].chain;
  const LegChain& chain_b = model.legs[b.leg].chain;
  ChainPlace place_a, place_b;
  chain_a.place(model.legs[a.leg].home, place_a);
  chain_b.place(model.legs[b.leg].home, place_b);
  const bool on_base = chain_a.joints[a.joint].parent < 0 && chain_b.joints[b.joint].parent < 0;
  if (on_base && (place_a.origin[a.joint] - place_b.origin[b.joint]).norm() < same) return true;
  for (const ChainClosure& of_a : model.legs[a.leg].closures) {
    for (const ChainClosure& of_b : model.legs[b.leg].closures) {
      if (of_a.joint != a.joint || of_b.joint != b.joint) continue;
      if ((of_a.on_at - of_b.on_at).norm() < same) return true;
    }
  }
  return false;
}

std::vector<BodyPair> watched_pairs(const LegsModel& model, const std::vector<Body>& bodies) {
  std::vector<BodyPair> watched;
  for (const BodyPair& pair : pairs_of_different_legs(bodies)) {
    const auto a = static_cast<std::size_t>(pair.a);
    const auto b = static_cast<std::size_t>(pair.b);
    if (bodies[a].shapes.empty() || bodies[b].shapes.empty()) continue;
    if (!are_neighbours(model, model.bodies[a - 1], model.bodies[b - 1])) watched.push_back(pair);
  }
  return watched;
}

MechanismDescription describe(const LegsParameters& parameters, const LegsModel& model) {
  MechanismDescription description{.name = parameters.name,
                                   .space = model.moves.space,
                                   .drives = {},
                                   .bodies = bodies_of_robot(parameters),
                                   .self_collision_pairs = {},
                                   .gravity = model.gravity,
                                   .home_pose = home_configuration(model),
                                   .characteristic_length = model.characteristic_length};
  for (const ModelDrive& drive : model.drives) description.drives.push_back(drive.kind);
  description.self_collision_pairs = watched_pairs(model, description.bodies);
  return description;
}

void scale(RigidBodyInertia& body, double factor) { body = scaled(body, factor); }

bool is_driven(const LegsModel& model, std::size_t leg, std::size_t joint, std::size_t& drive) {
  for (drive = 0; drive < model.drives.size(); ++drive) {
    for (const ModelDrive::Term& term : model.drives[drive].terms) {
      if (term.leg == leg && term.joint == joint) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::string> problems(const LegsParameters& parameters) {
  return legs_model(parameters).problems;
}

LegsRobot::LegsRobot(const LegsParameters& parameters)
    : LegsRobot([&] {
        LegsModel model = sound_model(parameters);
        MechanismDescription description = describe(parameters, model);
        return LegsRobot(std::move(description), std::move(model));
      }()) {}

LegsRobot::LegsRobot(MechanismDescription description, LegsModel model)
    : ParallelRobot(std::move(description)), model_(std::move(model)) {
  find_ends();
}

void LegsRobot::find_ends() {
  for (int i = 0; i < legs(); ++i) {
    const auto in_space = [](const CartesianVector& point) {
      return Eigen::Vector3d(point[0], point[1], point.size() == 3 ? point[2] : 0.0);
    };
    ends_[static_cast<std::size_t>(i)] = {in_space(axis_point(BodyId::link1(i), 0.0)),
                                          in_space(axis_point(BodyId::link1(i), 1.0)),
                                          in_space(axis_point(BodyId::link2(i), 1.0))};
  }
}

/// Of a drive of one joint; drives of several feel the friction of each only together.
DryFriction LegsRobot::dry_friction(int drive) const noexcept {
  const std::vector<ModelDrive::Term>& terms = model_.drives[static_cast<std::size_t>(drive)].terms;
  if (terms.size() != 1 || terms[0].weight == 0.0) return {};
  const ChainJoint& joint = model_.legs[terms[0].leg].chain.joints[terms[0].joint];
  const double weight = std::abs(terms[0].weight);
  return {.effort = joint.friction.coulomb / weight, .velocity = legs_friction_velocity * weight};
}

std::shared_ptr<const Mechanism> LegsRobot::deviating(const RobotDeviation& deviation) const {
  LegsModel robot = model_;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    for (std::size_t j = 0; j < robot.legs[i].chain.joints.size(); ++j) {
      ChainJoint& joint = robot.legs[i].chain.joints[j];
      std::size_t drive = 0;
      const double of_friction = is_driven(robot, i, j, drive)
                                     ? scale_of(deviation.drive_friction_scale, drive)
                                     : scale_of(deviation.passive_friction_scale, i);
      joint.friction = scaled(joint.friction, of_friction);
      scale(joint.link, scale_of(deviation.leg_inertia_scale, i));
    }
  }
  scale(robot.platform, deviation.platform_inertia_scale);
  if (deviation.payload > 0.0)
    robot.platform = together(robot.platform, RigidBodyInertia{.mass = deviation.payload});
  return with(std::move(robot));
}

std::shared_ptr<const LegsRobot> LegsRobot::with(LegsModel model) const {
  return std::shared_ptr<const LegsRobot>(new LegsRobot(description(), std::move(model)));
}

// ---------------------------------------------------------------- what a kinematics carries

JointCounts LegsRobot::joint_counts() const noexcept {
  return {.active = drives(), .passive = passive_joints(), .coupling = 0};
}

bool LegsRobot::is_usable(const Configuration& pose, const WorkingMode& mode) const noexcept {
  if (!usable(pose, space().stored()) || !space().contains(pose) || mode.size() != legs()) return false;
  for (int i = 0; i < legs(); ++i) {
    if (!is_working_mode(model_, static_cast<std::size_t>(i), mode[i])) return false;
  }
  return true;
}

bool LegsRobot::serves(const Kinematics& kinematics) const noexcept {
  Eigen::Index searched = model_.following();
  for (const ModelLeg& leg : model_.legs) searched += leg.chain.coordinates;
  return kinematics.reachable && kinematics.pose.size() == space().stored() &&
         kinematics.velocity.size() == dof() && kinematics.searched.size() == searched;
}

bool LegsRobot::serves(const Kinematics& kinematics, BodyId body,
                       const CartesianVector& point) const noexcept {
  return serves(kinematics) && usable(point, space_dimension()) && body.index() >= 0 &&
         body.index() < body_count();
}

LegsState LegsRobot::state_of(const Kinematics& kinematics) const noexcept {
  LegsState state;
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < model_.legs.size(); ++i) {
    state.s[i] = kinematics.searched.segment(next, model_.legs[i].chain.coordinates);
    next += model_.legs[i].chain.coordinates;
  }
  state.z = kinematics.searched.tail(model_.following());
  return state;
}

// ---------------------------------------------------------------- dynamics and points

void LegsRobot::dynamics(const Kinematics& kinematics, Dynamics& out) const noexcept {
  if (!serves(kinematics)) return set_invalid(dof(), out);
  LegsMotion motion;
  motion.set(model_, kinematics.pose, kinematics.velocity, state_of(kinematics));
  LegsDynamics sum;
  sum.set(model_, motion);
  if (!sum.M.allFinite() || !sum.C.allFinite() || !sum.g.allFinite() || !sum.F_fr.allFinite())
    return set_invalid(dof(), out);
  out = {sum.M, sum.C, sum.g, sum.F_fr, true};
}

namespace {

Eigen::Vector3d in_space(const CartesianVector& point) {
  return {point[0], point[1], point.size() == 3 ? point[2] : 0.0};
}

}  // namespace

CartesianVector LegsRobot::point_on_body(const Kinematics& kinematics, BodyId body,
                                         const CartesianVector& point_in_body) const noexcept {
  if (!serves(kinematics, body, point_in_body)) return CartesianVector::Zero(space_dimension());
  const LegsState state = state_of(kinematics);
  const Eigen::Vector3d y = in_space(point_in_body);
  if (body.is_platform()) {
    PlatformTwist platform;
    model_.place(kinematics.pose, state.z, platform);
    return (platform.origin + platform.axes * y).head(space_dimension());
  }
  const JointOfLeg& link = model_.bodies[static_cast<std::size_t>(body.index() - 1)];
  ChainPlace place;
  model_.legs[link.leg].chain.place(state.s[link.leg], place);
  return (place.origin[link.joint] + place.axes[link.joint] * y).head(space_dimension());
}

// J_c = J_v G, dJ_c = dJ_v G + J_v dG; the platform's from T.
ContactJacobian LegsRobot::contact_jacobian(const Kinematics& kinematics, BodyId body,
                                            const CartesianVector& point_in_body) const noexcept {
  const int directions = space_dimension();
  const int rotations = directions == 2 ? 1 : 3;
  ContactJacobian contact;
  for (auto* J : {&contact.translation, &contact.d_translation}) J->setZero(directions, dof());
  for (auto* J : {&contact.rotation, &contact.d_rotation}) J->setZero(rotations, dof());
  contact.valid = serves(kinematics, body, point_in_body);
  if (!contact.valid) return contact;
  const auto write = [&](Eigen::Index column, double factor, const Eigen::Vector3d& v,
                         const Eigen::Vector3d& w, CartesianJacobian& translation,
                         CartesianJacobian& rotation) {
    translation.col(column) += factor * v.head(directions);
    rotation.col(column) += factor * w.tail(rotations);
  };
  LegsMotion motion;
  const LegsState state = state_of(kinematics);
  const Eigen::Vector3d y = in_space(point_in_body);
  if (body.is_platform()) {
    motion.set_platform(model_, kinematics.pose, kinematics.velocity, state);
    const PlatformTwist& at = motion.platform;
    const Eigen::Vector3d arm = at.axes * y;
    const Eigen::Vector3d arm_rate = at.omega().cross(arm);
    for (Eigen::Index i = 0; i < dof(); ++i) {
      const Eigen::Vector3d w = at.T.col(i).tail<3>();
      const Eigen::Vector3d dw = at.dT.col(i).tail<3>();
      write(i, 1.0, at.T.col(i).head<3>() + w.cross(arm), w, contact.translation, contact.rotation);
      write(i, 1.0, at.dT.col(i).head<3>() + dw.cross(arm) + w.cross(arm_rate), dw, contact.d_translation,
            contact.d_rotation);
    }
    return contact;
  }
  const JointOfLeg& link = model_.bodies[static_cast<std::size_t>(body.index() - 1)];
  const LegChain& chain = model_.legs[link.leg].chain;
  motion.set_for(model_, kinematics.pose, kinematics.velocity, state, link.leg);
  const LegMotion& leg = motion.legs[link.leg];
  const Eigen::Vector3d arm = leg.place.axes[link.joint] * y;
  PointColumns columns;
  chain.columns(leg.place, leg.rates, link.joint, leg.place.origin[link.joint] + arm,
                leg.rates.velocity[link.joint] + leg.rates.omega[link.joint].cross(arm), columns);
  for (Eigen::Index i = 0; i < dof(); ++i) {
    for (int m = 0; m < chain.coordinates; ++m) {
      const auto of = static_cast<std::size_t>(m);
      write(i, leg.G(m, i), columns.v[of], columns.w[of], contact.translation, contact.rotation);
      write(i, leg.G(m, i), columns.dv[of], columns.dw[of], contact.d_translation, contact.d_rotation);
      write(i, leg.dG(m, i), columns.v[of], columns.w[of], contact.d_translation, contact.d_rotation);
    }
  }
  return contact;
}

}  // namespace flinch
