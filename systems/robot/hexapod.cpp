#include "systems/robot/hexapod.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <variant>

#include "systems/foundation/setup_error.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/hexapod_outline.h"
#include "systems/robot/robot_deviation.h"
#include "systems/robot/rotation.h"

namespace flinch {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr JointCounts joints{.active = 6, .passive = 0, .coupling = 0};

constexpr int max_iterations = 10;
constexpr double largest_length_error = 1e-10;  // [m]
constexpr double largest_last_step = 1e-8;      // [m, rad]
// Beyond this, inverting the drive map leaves less than ten digits.
constexpr double largest_condition_number = 1e6;
// A leg nearer to the first axis of its universal joint cannot be said to turn about it.
constexpr double least_sine_squared = 1e-12;

ConvexHull prism(double radius, double bottom, double top) {
  ConvexHull hull;
  for (int i = 0; i < 12; ++i) {
    const double angle = i * std::numbers::pi / 6.0;
    for (const double z : {bottom, top}) {
      hull.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  return hull;
}

std::vector<Body> bodies(const HexapodParameters& p) {
  std::vector<Body> bodies = {
      {body_name(BodyId::platform()), -1, {prism(p.platform_radius, p.platform_bottom, p.platform_top)}}};
  for (int leg = 0; leg < 6; ++leg) {
    const Capsule cylinder{.end = p.cylinder_length * Eigen::Vector3d::UnitZ(), .radius = p.cylinder_radius};
    const Capsule rod{.begin = -p.rod_length * Eigen::Vector3d::UnitZ(), .radius = p.rod_radius};
    bodies.push_back({body_name(BodyId::link1(leg)), leg, {cylinder}});
    bodies.push_back({body_name(BodyId::link2(leg)), leg, {rod}});
  }
  return bodies;
}

/// Cylinders, and rods beyond what belongs to their joints.
std::vector<BesidePlatform> beside_platform(const HexapodParameters& p, const std::vector<Body>& bodies) {
  const std::array<double, 6> held = held_stretches(p);
  std::vector<BesidePlatform> beside;
  for (int leg = 0; leg < 6; ++leg) {
    const int cylinder = BodyId::link1(leg).index(), rod = BodyId::link2(leg).index();
    Capsule apart = std::get<Capsule>(bodies[static_cast<std::size_t>(rod)].shapes.front());
    apart.end = -held[static_cast<std::size_t>(leg)] * Eigen::Vector3d::UnitZ();
    beside.push_back({cylinder, bodies[static_cast<std::size_t>(cylinder)].shapes.front()});
    beside.push_back({rod, apart});
  }
  return beside;
}

Configuration home_pose(const HexapodParameters& parameters) {
  Configuration pose(7);
  pose << parameters.home_position, quaternion_exp(parameters.home_rotation);
  return pose;
}

MechanismDescription describe(const HexapodParameters& parameters) {
  throw_if_any(problems(parameters));
  MechanismDescription description{.name = parameters.name,
                                   .space = ConfigurationSpace::Kind::spatial_pose,
                                   .drives = std::vector<DriveKind>(6, DriveKind::prismatic),
                                   .bodies = bodies(parameters),
                                   .self_collision_pairs = {},
                                   .beside_platform = {},
                                   .gravity = parameters.gravity,
                                   .home_pose = home_pose(parameters),
                                   .characteristic_length = parameters.characteristic_length};
  description.self_collision_pairs = pairs_of_different_legs(description.bodies);
  description.beside_platform = beside_platform(parameters, description.bodies);
  return description;
}

bool is_working_mode(const WorkingMode& mode) { return mode.size() == 6 && (mode.array() == 0).all(); }

// Infinite if A is singular to working precision.
double condition_number(const Matrix6& A) {
  const Matrix6 A_squared = A.transpose() * A;
  const Eigen::SelfAdjointEigenSolver<Matrix6> squared(A_squared, Eigen::EigenvaluesOnly);
  const double smallest = squared.eigenvalues()[0];
  const double largest = squared.eigenvalues()[5];
  const bool regular = smallest > std::numeric_limits<double>::epsilon() * largest;
  return regular ? std::sqrt(largest / smallest) : std::numeric_limits<double>::infinity();
}

}  // namespace

Hexapod::Hexapod(const HexapodParameters& parameters)
    : ParallelRobot(describe(parameters)),
      parameters_(parameters),
      held_stretches_(held_stretches(parameters)) {
  loaded_platform_ =
      parameters.payload ? together(parameters.platform, *parameters.payload) : parameters.platform;
  platform_inertia_ = about_origin(loaded_platform_);
  for (std::size_t i = 0; i < 6; ++i) {
    cylinders_[i] = scaled(parameters.cylinder, parameters.legs[i].mass_scale);
    rods_[i] = scaled(parameters.rod, parameters.legs[i].mass_scale);
    link_inertia_[i] = about_origin(cylinders_[i]) + about_origin(rods_[i]);
  }
  scale_ << Eigen::Vector3d::Ones(), Eigen::Vector3d::Constant(1.0 / parameters.characteristic_length);
}

WorkingMode Hexapod::home_working_mode() const noexcept { return WorkingMode::Zero(6); }

WorkingMode Hexapod::working_mode(const JointVector& /*passive*/) const noexcept {
  return home_working_mode();
}

// ---------------------------------------------------------------- legs

Hexapod::Platform Hexapod::platform(const Configuration& pose, const Twist& velocity) noexcept {
  const Eigen::Vector4d quaternion = pose.tail<4>();
  return {pose.head<3>(), rotation_matrix(quaternion.normalized()), velocity};
}

Hexapod::Leg Hexapod::leg(std::size_t index, const Platform& platform) const noexcept {
  const HexapodLeg& geometry = parameters_.legs[index];
  Leg leg;
  leg.arm = platform.axes * geometry.platform_joint;
  const Eigen::Vector3d span = platform.origin + leg.arm - geometry.base_joint;
  leg.length = span.norm();
  leg.direction = span / leg.length;
  leg.sine_squared = geometry.universal_axis.cross(leg.direction).squaredNorm();
  return leg;
}

bool Hexapod::reaches(const Leg& leg) const noexcept {
  return leg.length > parameters_.rod_length &&
         leg.length < parameters_.rod_length + parameters_.cylinder_length &&
         leg.sine_squared > least_sine_squared;
}

// Row [s^T, (r x s)^T].
Hexapod::LegRates Hexapod::rates(const Leg& leg, const Platform& platform) noexcept {
  const Eigen::Vector3d omega = platform.velocity.tail<3>();
  const Eigen::Vector3d arm_rate = omega.cross(leg.arm);
  const Eigen::Vector3d span_rate = platform.velocity.head<3>() + arm_rate;
  LegRates rates;
  rates.length_rate = leg.direction.dot(span_rate);
  rates.direction_rate = (span_rate - rates.length_rate * leg.direction) / leg.length;
  rates.row << leg.direction.transpose(), leg.arm.cross(leg.direction).transpose();
  rates.row_rate << rates.direction_rate.transpose(),
      (arm_rate.cross(leg.direction) + leg.arm.cross(rates.direction_rate)).transpose();
  return rates;
}

PointMotion<6> Hexapod::joint_motion(const Leg& leg, const Platform& platform) noexcept {
  const Eigen::Vector3d omega = platform.velocity.tail<3>();
  PointMotion<6> joint;
  joint.J << Eigen::Matrix3d::Identity(), -cross_matrix(leg.arm);
  joint.dJ << Eigen::Matrix3d::Zero(), -cross_matrix(omega.cross(leg.arm));
  return joint;
}

// J_s = (I - s s^T) J / q maps to the velocity of s, J to that of the joint.
UniversalLeg<6> Hexapod::universal(std::size_t index, const Leg& leg, const LegRates& rates,
                                   const PointMotion<6>& joint) const noexcept {
  const Eigen::Vector3d& s = leg.direction;
  const Map J_s = (joint.J - s * rates.row) / leg.length;
  const Map dJ_s = (joint.dJ - rates.direction_rate * rates.row - s * rates.row_rate) / leg.length -
                   rates.length_rate / leg.length * J_s;
  return universal_leg<6>(universal_turn(parameters_.legs[index].universal_axis, s, rates.direction_rate),
                          J_s, dJ_s);
}

// ---------------------------------------------------------------- bodies

BodyMotion<6> Hexapod::platform_motion(const Platform& platform) noexcept {
  BodyMotion<6> body;
  body.origin = platform.origin;
  body.axes = platform.axes;
  body.J_o.leftCols<3>().setIdentity();
  body.J_w.rightCols<3>().setIdentity();
  return body;
}

BodyMotion<6> Hexapod::cylinder_motion(std::size_t index, const UniversalLeg<6>& leg) const noexcept {
  return {.origin = parameters_.legs[index].base_joint,
          .axes = leg.axes,
          .J_o = Map::Zero(),
          .J_w = leg.J_w,
          .dJ_o = Map::Zero(),
          .dJ_w = leg.dJ_w};
}

BodyMotion<6> Hexapod::rod_motion(const Leg& leg, const PointMotion<6>& joint,
                                  const UniversalLeg<6>& universal, const Platform& platform) noexcept {
  return {.origin = platform.origin + leg.arm,
          .axes = universal.axes,
          .J_o = joint.J,
          .J_w = universal.J_w,
          .dJ_o = joint.dJ,
          .dJ_w = universal.dJ_w};
}

BodyMotion<6> Hexapod::motion(BodyId body, const Platform& platform) const noexcept {
  if (body.is_platform()) return platform_motion(platform);
  const auto index = static_cast<std::size_t>(body.leg());
  const Leg closed = leg(index, platform);
  const PointMotion<6> joint = joint_motion(closed, platform);
  const UniversalLeg<6> turning = universal(index, closed, rates(closed, platform), joint);
  return body.is_link1() ? cylinder_motion(index, turning) : rod_motion(closed, joint, turning, platform);
}

// ---------------------------------------------------------------- inverse and forward kinematics

InverseSolution Hexapod::inverse_kinematics(const Configuration& pose,
                                            const WorkingMode& mode) const noexcept {
  const InverseSolution unreachable{{JointVector::Zero(6), JointVector(0), JointVector(0)}, false};
  if (!is_working_mode(mode) || !usable(pose, 7) || !space().contains(pose)) return unreachable;
  InverseSolution solution = unreachable;
  const Platform at = platform(pose, Twist::Zero());
  for (std::size_t i = 0; i < 6; ++i) {
    const Leg closed = leg(i, at);
    if (!reaches(closed)) return unreachable;
    solution.joints.active[static_cast<int>(i)] = closed.length;
  }
  solution.reachable = true;
  return solution;
}

// Newton's method on the leg lengths: x <- x (+) A(x)^-1 (q - q(x)). The sign of det A tells whether the
// pose found is assembled as the start is.
ForwardSolution Hexapod::forward_kinematics(const JointVector& active, const Configuration& start,
                                            const WorkingMode& mode) const noexcept {
  ForwardSolution solution{home_pose(), 0, false};
  if (!usable(active, 6) || !inverse_kinematics(start, mode).reachable) return solution;

  Configuration pose = start;
  double determinant_at_start = 0.0;
  bool met = false;
  while (!met && solution.iterations < max_iterations) {
    const Platform at = platform(pose, Twist::Zero());
    Matrix6 A;
    Vector6 error;
    for (int i = 0; i < 6; ++i) {
      const Leg closed = leg(static_cast<std::size_t>(i), at);
      A.row(i) << closed.direction.transpose(), closed.arm.cross(closed.direction).transpose();
      error[i] = active[i] - closed.length;
    }
    const Eigen::PartialPivLU<Matrix6> lu(A);
    const Vector6 step = lu.solve(error);
    if (!step.allFinite() || step.tail<3>().norm() > std::numbers::pi) break;
    if (solution.iterations == 0) determinant_at_start = lu.determinant();
    pose = space().plus(pose, step);
    ++solution.iterations;
    met = error.lpNorm<Eigen::Infinity>() < largest_length_error &&
          step.lpNorm<Eigen::Infinity>() < largest_last_step;
    solution.converged = met && lu.determinant() * determinant_at_start > 0.0;
  }
  solution.other_branch = met && !solution.converged;
  if (!space().contains(pose)) return solution;
  solution.pose = pose;
  solution.converged = solution.converged && inverse_kinematics(pose, mode).reachable;
  return solution;
}

Configuration Hexapod::start_pose(const JointVector& /*active*/,
                                  const JointVector& /*passive*/) const noexcept {
  return home_pose();
}

double Hexapod::chain_closure_error(const JointVector& active, const JointVector& passive,
                                    const Configuration& pose) const noexcept {
  const bool all_usable = usable(active, 6) && passive.size() == 0 && space().contains(pose);
  return all_usable ? 0.0 : std::numeric_limits<double>::infinity();
}

double Hexapod::platform_gap(const Kinematics& kinematics) const noexcept {
  return kinematics.reachable ? leg_platform_gap(parameters_, held_stretches_, kinematics) : 0.0;
}

// ---------------------------------------------------------------- differential kinematics

// What needs no inverse of the drive map.
bool Hexapod::close(const Configuration& pose, const PlatformVector& velocity, const WorkingMode& mode,
                    Closed& closed, Kinematics& out) const noexcept {
  const bool is_usable =
      usable(velocity, 6) && is_working_mode(mode) && usable(pose, 7) && space().contains(pose);
  // Which may be part of `out`. NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
  const Configuration x = pose;
  if (is_usable) closed.platform = platform(pose, velocity);
  set_unreachable(space(), joints, out);
  if (!is_usable) return false;
  const Platform& at = closed.platform;
  for (std::size_t i = 0; i < 6; ++i) {
    closed.legs[i].leg = leg(i, at);
    if (!reaches(closed.legs[i].leg)) return false;
  }
  out.pose = x;
  out.velocity = at.velocity;
  out.det_B = 1.0;
  for (int i = 0; i < 6; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const Leg& leg = closed.legs[index].leg;
    const Eigen::Vector3d& base = parameters_.legs[index].base_joint;
    const LegRates& moving = closed.legs[index].rates = rates(leg, at);
    out.J_qa_x.row(i) = moving.row;
    out.dJ_qa_x.row(i) = moving.row_rate;
    out.joints.active[i] = leg.length;
    out.rates.active[i] = moving.length_rate;
    out.det_B *= leg.sine_squared;
    out.legs[index] = {base, base + parameters_.cylinder_length * leg.direction, at.origin + leg.arm};
  }
  out.reachable = true;
  return true;
}

void Hexapod::kinematics(const Configuration& pose, const PlatformVector& velocity, const WorkingMode& mode,
                         Kinematics& out) const noexcept {
  Closed closed;
  if (!close(pose, velocity, mode, closed, out)) return;
  const Matrix6 A = out.J_qa_x;
  const Matrix6 dA = out.dJ_qa_x;
  const Matrix6 scaled = A * scale_.asDiagonal();
  const Eigen::PartialPivLU<Matrix6> lu(A);
  out.det_A = lu.determinant() * scale_.prod();
  out.sigma_kappa = condition_number(scaled);
  out.valid = out.sigma_kappa < largest_condition_number;
  if (out.valid) {
    const Matrix6 J_x = lu.inverse();
    out.J_x_qa = J_x;
    out.dJ_x_qa = -J_x * dA * J_x;
  }
  if (!all_finite(out)) set_unreachable(space(), joints, out);
}

DryFriction Hexapod::dry_friction(int drive) const noexcept {
  const double coulomb = parameters_.legs[static_cast<std::size_t>(drive)].drive_friction.coulomb;
  return {.effort = coulomb, .velocity = parameters_.drive_friction_velocity};
}

std::shared_ptr<const Mechanism> Hexapod::deviating(const RobotDeviation& deviation) const {
  HexapodParameters robot = parameters_;
  for (std::size_t i = 0; i < 6; ++i) {
    HexapodLeg& leg = robot.legs[i];
    leg.mass_scale *= scale_of(deviation.leg_inertia_scale, i);
    leg.drive_friction = scaled(leg.drive_friction, scale_of(deviation.drive_friction_scale, i));
    leg.universal_friction = scaled(leg.universal_friction, scale_of(deviation.passive_friction_scale, i));
  }
  robot.platform = scaled(robot.platform, deviation.platform_inertia_scale);
  if (deviation.payload > 0.0) {
    robot.platform = together(robot.platform, RigidBodyInertia{.mass = deviation.payload});
  }
  return std::make_shared<const Hexapod>(robot);
}

// ---------------------------------------------------------------- points

bool Hexapod::serves(const Kinematics& kinematics, BodyId body, const CartesianVector& point) const noexcept {
  return kinematics.reachable && kinematics.pose.size() == 7 && drive_count(kinematics) == 6 &&
         usable(point, 3) && body.index() >= 0 && body.index() < body_count();
}

CartesianVector Hexapod::point_on_body(const Kinematics& kinematics, BodyId body,
                                       const CartesianVector& point_in_body) const noexcept {
  if (!serves(kinematics, body, point_in_body)) return CartesianVector::Zero(3);
  const BodyMotion<6> moving = motion(body, platform(kinematics.pose, kinematics.velocity));
  return moving.origin + moving.axes * point_in_body.head<3>();
}

ContactJacobian Hexapod::contact_jacobian(const Kinematics& kinematics, BodyId body,
                                          const CartesianVector& point_in_body) const noexcept {
  ContactJacobian contact;
  contact.valid = serves(kinematics, body, point_in_body);
  if (!contact.valid) {
    for (auto* J : {&contact.translation, &contact.rotation, &contact.d_translation, &contact.d_rotation}) {
      J->setZero(3, 6);
    }
    return contact;
  }
  const Platform at = platform(kinematics.pose, kinematics.velocity);
  const BodyMotion<6> moving = motion(body, at);
  const Eigen::Vector3d arm = moving.axes * point_in_body.head<3>();
  const PointMotion<6> point = moving.point(arm, moving.J_w * at.velocity);
  contact.translation = point.J;
  contact.d_translation = point.dJ;
  contact.rotation = moving.J_w;
  contact.d_rotation = moving.dJ_w;
  return contact;
}

}  // namespace flinch
