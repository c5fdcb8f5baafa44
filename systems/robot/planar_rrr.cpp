#include "systems/robot/planar_rrr.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/robot/angles.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/planar_contact.h"
#include "systems/robot/planar_determinants.h"
#include "systems/robot/planar_kinematics.h"
#include "systems/robot/planar_self_collision.h"

namespace flinch {
namespace {

constexpr int max_iterations = 10;
constexpr double largest_angle_error = 1e-10;  // [rad]
constexpr double largest_last_step = 1e-8;     // [m, rad]
constexpr double largest_near_error = 0.05;    // [rad]

// A small error alone does not prove convergence: near a singularity it still allows a long step.
bool is_last(const Eigen::Vector3d& angle_error, const Eigen::Vector3d& step) {
  return angle_error.lpNorm<Eigen::Infinity>() < largest_angle_error &&
         step.lpNorm<Eigen::Infinity>() < largest_last_step;
}

// Signs of the passive angles; nothing unless the working mode has three entries of 0 or 1.
std::optional<std::array<double, 3>> elbow_signs(const WorkingMode& mode) {
  if (mode.size() != 3 || (mode.array() < 0).any() || (mode.array() > 1).any()) return std::nullopt;
  return std::array{1.0 - 2.0 * mode[0], 1.0 - 2.0 * mode[1], 1.0 - 2.0 * mode[2]};
}

MechanismDescription describe(const PlanarRrrParameters& parameters) {
  throw_if_any(problems(parameters));
  MechanismDescription description{
      .name = parameters.name,
      .space = ConfigurationSpace::Kind::planar_pose,
      .drives = std::vector<DriveKind>(3, DriveKind::revolute),
      .bodies = planar_bodies(parameters.platform_hull_radius, parameters.legs, parameters.link_radius),
      .self_collision_pairs = {},
      .gravity = parameters.gravity,
      .home_pose = parameters.home_pose};
  description.self_collision_pairs = pairs_of_different_legs(description.bodies);
  return description;
}

}  // namespace

PlanarRrr::PlanarRrr(const PlanarRrrParameters& parameters)
    : ParallelRobot(describe(parameters)), parameters_(parameters) {
  for (std::size_t i = 0; i < 3; ++i) {
    const PlanarRrrLeg& leg = parameters.legs[i];
    geometry_[i] = leg_geometry(leg, -leg.base_radius * normal(unit_vector(leg.base_angle)),
                                parameters.coupling_radius * unit_vector(leg.coupling_angle));
    home_signs_[i] = parameters.legs[i].elbow_sign;
  }
}

WorkingMode PlanarRrr::home_working_mode() const noexcept {
  WorkingMode mode(3);
  for (int i = 0; i < 3; ++i) mode[i] = parameters_.legs[static_cast<std::size_t>(i)].elbow_sign > 0 ? 0 : 1;
  return mode;
}

// ---------------------------------------------------------------- legs

void PlanarRrr::motion(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity, const ElbowSigns& signs,
                       PlanarMotion& out) const noexcept {
  out.pose = pose;
  out.velocity = velocity;
  out.reachable = true;
  const Eigen::Vector2d origin = pose.head<2>();
  const Eigen::Vector2d axis = unit_vector(pose.z());
  for (std::size_t i = 0; i < 3 && out.reachable; ++i) {
    const PlanarLeg leg = close_leg(geometry_[i], origin, axis, signs[i]);
    out.reachable = leg.reachable;
    if (leg.reachable) out.legs[i] = leg_motion(geometry_[i], leg, velocity);
  }
}

void PlanarRrr::motion(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity,
                       PlanarMotion& out) const noexcept {
  motion(pose, velocity, home_signs_, out);
}

PlanarMotion PlanarRrr::motion(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity) const noexcept {
  PlanarMotion now;
  motion(pose, velocity, home_signs_, now);
  return now;
}

Eigen::Vector3d PlanarRrr::active_error(const JointVector& active,
                                        const PlanarMotion& motion) const noexcept {
  Eigen::Vector3d error;
  for (int i = 0; i < 3; ++i) {
    const auto leg = static_cast<std::size_t>(i);
    error[i] = wrap_angle(active[i] - active_angle(geometry_[leg], motion.legs[leg].leg));
  }
  return error;
}

// Nothing out of reach.
std::optional<PlanarRrr::Legs> PlanarRrr::close_legs(const Eigen::Vector3d& pose,
                                                     const ElbowSigns& signs) const noexcept {
  const Eigen::Vector2d origin = pose.head<2>();
  const Eigen::Vector2d axis = unit_vector(pose.z());
  Legs legs;
  for (std::size_t i = 0; i < 3; ++i) {
    legs[i] = close_leg(geometry_[i], origin, axis, signs[i]);
    if (!legs[i].reachable) return std::nullopt;
  }
  return legs;
}

JointAngles PlanarRrr::joint_angles(const PlanarMotion& motion) const noexcept {
  return joint_angles(motion.pose.z(), {&motion.legs[0].leg, &motion.legs[1].leg, &motion.legs[2].leg});
}

JointAngles PlanarRrr::joint_angles(double phi, const std::array<const PlanarLeg*, 3>& legs) const noexcept {
  JointAngles angles{JointVector(3), JointVector(3), JointVector(3)};
  for (int i = 0; i < 3; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const PlanarLeg& leg = *legs[index];
    angles.active[i] = active_angle(geometry_[index], leg);
    angles.passive[i] = passive_angle(leg);
    const double theta2 = geometry_[index].base_angle + angles.active[i] + angles.passive[i];
    angles.coupling[i] = wrap_angle(phi - theta2);
  }
  return angles;
}

// ---------------------------------------------------------------- inverse and forward kinematics

InverseSolution PlanarRrr::inverse_kinematics(const Configuration& pose,
                                              const WorkingMode& mode) const noexcept {
  const auto zero = JointVector::Zero(3);
  InverseSolution solution{{zero, zero, zero}, false};
  const auto signs = elbow_signs(mode);
  if (!signs || !usable(pose, 3)) return solution;
  const auto legs = close_legs(pose, *signs);
  if (!legs) return solution;
  return {joint_angles(pose[2], {legs->data(), legs->data() + 1, legs->data() + 2}), true};
}

// From a start nearby, the lengths of the second links determine the pose without any inverse kinematics.
// From elsewhere they could lead to another side of an elbow.
ForwardSolution PlanarRrr::forward_kinematics(const JointVector& active, const Configuration& start,
                                              const WorkingMode& mode) const noexcept {
  const auto signs = elbow_signs(mode);
  if (!signs || !usable(active, 3) || !usable(start, 3)) return {home_pose(), 0};
  const Eigen::Vector3d angles = active;
  const Eigen::Vector3d pose = start;
  const ForwardSolution near = solve_lengths(angles, pose, *signs);
  return near.converged ? near : solve_angles(angles, pose, *signs);
}

// Newton's method on f = (|v|^2 - l2^2) / 2 = 0, v from the elbow to the coupling joint of each leg, with the
// rows [v^T, d x v], which are those of A to a factor. Its drive has the angle error f / (l1 u1 x v); u1 x v
// has the sign of its elbow.
ForwardSolution PlanarRrr::solve_lengths(const Eigen::Vector3d& active, Eigen::Vector3d pose,
                                         const ElbowSigns& signs) const noexcept {
  std::array<Eigen::Vector2d, 3> u1, elbow;
  for (std::size_t i = 0; i < 3; ++i) {
    u1[i] = unit_vector(geometry_[i].base_angle + active[static_cast<int>(i)]);
    elbow[i] = geometry_[i].base_joint + geometry_[i].link1_length * u1[i];
  }
  ForwardSolution solution{home_pose(), 0};
  double determinant_at_start = 0.0;
  while (!solution.converged && solution.iterations < max_iterations) {
    const Eigen::Vector2d axis = unit_vector(pose.z());
    Eigen::Matrix3d rows;
    Eigen::Vector3d f, angle_error;
    bool same_branch = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const PlanarLegGeometry& leg = geometry_[i];
      const Eigen::Vector2d d = rotate(axis, leg.coupling_in_platform);
      const Eigen::Vector2d v = pose.head<2>() + d - elbow[i];
      const double u1_x_v = cross(u1[i], v);
      const int row = static_cast<int>(i);
      rows.row(row) << v.x(), v.y(), cross(d, v);
      f[row] = 0.5 * (v.squaredNorm() - leg.link2_length * leg.link2_length);
      angle_error[row] = f[row] / (leg.link1_length * u1_x_v);
      same_branch = same_branch && u1_x_v * signs[i] > 0.0;
    }
    const Eigen::Matrix3d adjugate_rows = adjugate(rows);
    const double determinant = rows.row(0).dot(adjugate_rows.col(0));
    if (solution.iterations == 0) determinant_at_start = determinant;
    same_branch = same_branch && determinant * determinant_at_start > 0.0;
    if (!same_branch || !(angle_error.array().abs() < largest_near_error).all()) break;
    const Eigen::Vector3d step = adjugate_rows * f / determinant;
    pose -= step;
    ++solution.iterations;
    solution.converged = is_last(angle_error, step);
  }
  if (solution.converged) solution.pose << pose.head<2>(), wrap_angle(pose.z());
  return solution;
}

// Newton's method on the drive angles: x <- x + J_x,qa(x) (qa - IK(x)). While the elbows stay on their sides,
// det A changes its sign with det J_qa,x.
ForwardSolution PlanarRrr::solve_angles(const Eigen::Vector3d& active, Eigen::Vector3d pose,
                                        const ElbowSigns& signs) const noexcept {
  ForwardSolution solution{home_pose(), 0};
  double determinant_at_start = 0.0;
  bool met = false;
  while (!met && solution.iterations < max_iterations) {
    PlanarMotion closed;
    motion(pose, Eigen::Vector3d::Zero(), signs, closed);
    if (!closed.reachable) break;
    const Eigen::Matrix3d J_qa = stacked_rows(closed, &PlanarLegMotion::J_qa);
    const double determinant = J_qa.determinant();
    if (solution.iterations == 0) determinant_at_start = determinant;
    const Eigen::Vector3d error = active_error(active, closed);
    const Eigen::Vector3d step = J_qa.inverse() * error;
    if (!step.allFinite()) break;
    pose += step;
    ++solution.iterations;
    met = is_last(error, step);
    solution.converged = met && determinant * determinant_at_start > 0.0;
  }
  solution.other_branch = met && !solution.converged;
  if (usable(pose, 3)) solution.pose << pose.head<2>(), wrap_angle(pose.z());
  return solution;
}

// dx of [v^T, d x v] dx = l1 (u1 x v) dq_a, v along the second links.
std::optional<PlatformVector> PlanarRrr::platform_velocity(const Configuration& pose,
                                                           const JointVector& drive_rates,
                                                           const WorkingMode& mode) const noexcept {
  const auto signs = elbow_signs(mode);
  if (!signs || !usable(pose, 3) || !usable(drive_rates, 3)) return std::nullopt;
  const auto legs = close_legs(pose, *signs);
  if (!legs) return std::nullopt;
  Eigen::Matrix3d J_qa;
  for (int i = 0; i < 3; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const PlanarLeg& leg = (*legs)[index];
    const double lever = 1.0 / (geometry_[index].link1_length * leg.sin_qp);
    J_qa.row(i) << lever * leg.u2.x(), lever * leg.u2.y(), lever * cross(leg.arm, leg.u2);
  }
  const Eigen::Matrix3d J_x = J_qa.inverse();
  if (!is_regular(J_qa, J_x)) return std::nullopt;
  return J_x * drive_rates.head<3>();
}

// Rigid fit of the coupling joints, given in the platform frame, to the tips of the legs.
Configuration PlanarRrr::start_pose(const JointVector& active, const JointVector& passive) const noexcept {
  if (!usable(active, 3) || !usable(passive, 3)) return home_pose();
  std::array<Eigen::Vector2d, 3> tips;
  Eigen::Vector2d mean_tip = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_coupling = Eigen::Vector2d::Zero();
  for (int i = 0; i < 3; ++i) {
    const auto leg = static_cast<std::size_t>(i);
    tips[leg] = chain_tip(geometry_[leg], active[i], passive[i]);
    mean_tip += tips[leg] / 3.0;
    mean_coupling += geometry_[leg].coupling_in_platform / 3.0;
  }
  double sine = 0.0;
  double cosine = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector2d from = geometry_[i].coupling_in_platform - mean_coupling;
    const Eigen::Vector2d to = tips[i] - mean_tip;
    sine += cross(from, to);
    cosine += from.dot(to);
  }
  const double phi = std::atan2(sine, cosine);
  const Eigen::Vector2d origin = mean_tip - rotate(unit_vector(phi), mean_coupling);
  return Eigen::Vector3d(origin.x(), origin.y(), phi);
}

WorkingMode PlanarRrr::working_mode(const JointVector& passive) const noexcept {
  if (!usable(passive, 3)) return home_working_mode();
  return (passive.array() < 0.0).cast<int>();
}

double PlanarRrr::chain_closure_error(const JointVector& active, const JointVector& passive,
                                      const Configuration& pose) const noexcept {
  if (!usable(active, 3) || !usable(passive, 3) || !usable(pose, 3))
    return std::numeric_limits<double>::infinity();
  const Eigen::Vector2d origin = pose.head<2>();
  const Eigen::Vector2d axis = unit_vector(pose[2]);
  double error = 0.0;
  for (int i = 0; i < 3; ++i) {
    const auto leg = static_cast<std::size_t>(i);
    const Eigen::Vector2d& coupling = geometry_[leg].coupling_in_platform;
    const Eigen::Vector2d miss =
        chain_tip(geometry_[leg], active[i], passive[i]) - origin - rotate(axis, coupling);
    error = std::max(error, miss.lpNorm<Eigen::Infinity>());
  }
  return error;
}

double PlanarRrr::chain_closure_error(const PlanarMotion& motion) const noexcept {
  double error = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const PlanarLeg& leg = motion.legs[i].leg;
    const Eigen::Vector2d tip = leg.base_joint + geometry_[i].link1_length * leg.u1.normalized() +
                                geometry_[i].link2_length * leg.u2.normalized();
    error = std::max(error, (tip - leg.coupling_joint).lpNorm<Eigen::Infinity>());
  }
  return error;
}

// ---------------------------------------------------------------- differential kinematics

void PlanarRrr::kinematics(const Configuration& pose, const PlatformVector& velocity, const WorkingMode& mode,
                           Kinematics& out) const noexcept {
  constexpr JointCounts joints{.active = 3, .passive = 3, .coupling = 3};
  const auto signs = elbow_signs(mode);
  if (!signs || !usable(pose, 3) || !usable(velocity, 3)) return set_unreachable(space(), joints, out);
  PlanarMotion closed;
  motion(pose, velocity, *signs, closed);
  if (!closed.reachable) return set_unreachable(space(), joints, out);
  out.joints = joint_angles(closed);
  differential_kinematics(geometry_, closed, out);
  if (!all_finite(out)) set_unreachable(space(), joints, out);
}

void PlanarRrr::place(const Configuration& pose, PlaceKinematics& out) const noexcept {
  out.valid = false;
  if (!usable(pose, 3)) return;
  PlanarMotion closed;
  motion(pose.head<3>(), Eigen::Vector3d::Zero(), closed);
  if (closed.reachable) place_kinematics(geometry_, closed, out);
}

std::optional<DeterminantGradients> PlanarRrr::determinant_gradients(
    const Kinematics& kinematics) const noexcept {
  if (!kinematics.valid) return std::nullopt;
  return planar_determinant_gradients(*this, kinematics);
}

SelfCollisionTasks PlanarRrr::self_collision_tasks(const Kinematics& kinematics,
                                                   double distance) const noexcept {
  return coupling_angles(*this, kinematics, distance);
}

std::shared_ptr<const ParallelRobot> PlanarRrr::assembled_as(const WorkingMode& mode) const {
  const auto signs = elbow_signs(mode);
  if (!signs) return nullptr;
  PlanarRrrParameters robot = parameters_;
  for (std::size_t i = 0; i < 3; ++i) robot.legs[i].elbow_sign = (*signs)[i] > 0.0 ? 1 : -1;
  return std::make_shared<const PlanarRrr>(robot);
}

DryFriction PlanarRrr::dry_friction(int drive) const noexcept {
  const double coulomb = parameters_.legs[static_cast<std::size_t>(drive)].active_friction.coulomb;
  return {.effort = coulomb, .velocity = parameters_.friction_velocity};
}

std::shared_ptr<const Mechanism> PlanarRrr::deviating(const RobotDeviation& deviation) const {
  PlanarRrrParameters robot = parameters_;
  for (std::size_t i = 0; i < 3; ++i) robot.legs[i] = deviating_leg(robot.legs[i], deviation, i);
  robot.platform_mass = robot.platform_mass * deviation.platform_inertia_scale + deviation.payload;
  robot.platform_inertia *= deviation.platform_inertia_scale;
  return std::make_shared<const PlanarRrr>(robot);
}

CartesianVector PlanarRrr::point_on_body(const Kinematics& kinematics, BodyId body,
                                         const CartesianVector& point_in_body) const noexcept {
  return planar_point_on_body<3>(kinematics, 3, body, point_in_body);
}

ContactJacobian PlanarRrr::contact_jacobian(const Kinematics& kinematics, BodyId body,
                                            const CartesianVector& point_in_body) const noexcept {
  return planar_contact_jacobian<3>(kinematics, 3, body, point_in_body);
}

}  // namespace flinch
