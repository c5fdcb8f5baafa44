#include "apps/examples/08_own_mechanism/point_on_three_legs.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/planar_contact.h"
#include "systems/robot/planar_leg_dynamics.h"

using namespace flinch;

namespace {

constexpr int n = PointOnThreeLegs::leg_count;
constexpr double platform_radius = 0.03;       // of the outline about the point [m]
constexpr double link_radius = 0.02;           // [m]
constexpr double friction_velocity = 0.01;     // [rad/s]
constexpr double smallest_step = 1e-12;        // [m]
constexpr double largest_disagreement = 0.01;  // [rad]
constexpr JointCounts joints{.active = n, .passive = n, .coupling = 0};

using Map = Eigen::Matrix<double, n, 2>;
using Inverse = Eigen::Matrix<double, 2, n>;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

MechanismDescription describe(const PointOnThreeLegs::Parameters& parameters) {
  throw_if_any(problems(parameters));
  MechanismDescription description{
      .name = "point on three legs",
      .space = ConfigurationSpace::Kind::plane,
      .drives = std::vector<DriveKind>(n, DriveKind::revolute),
      .bodies = planar_bodies(platform_radius, parameters.legs, link_radius),
      .self_collision_pairs = {},
      .home_pose = parameters.home_pose,
  };
  // The second links always meet.
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      if (a < b)
        description.self_collision_pairs.push_back({BodyId::link1(a).index(), BodyId::link1(b).index()});
      if (a != b)
        description.self_collision_pairs.push_back({BodyId::link1(a).index(), BodyId::link2(b).index()});
    }
  }
  return description;
}

}  // namespace

PointOnThreeLegs::PointOnThreeLegs(const Parameters& parameters)
    : ParallelRobot(describe(parameters)), parameters_(parameters) {
  for (std::size_t i = 0; i < n; ++i) {
    geometry_[i] = leg_geometry(parameters.legs[i], parameters.legs[i].base_joint, Eigen::Vector2d::Zero());
  }
}

WorkingMode PointOnThreeLegs::home_working_mode() const noexcept {
  WorkingMode mode(n);
  for (int i = 0; i < n; ++i) mode[i] = parameters_.legs[index(i)].elbow_sign > 0 ? 0 : 1;
  return mode;
}

WorkingMode PointOnThreeLegs::working_mode(const JointVector& passive) const noexcept {
  if (!usable(passive, n)) return home_working_mode();
  return (passive.array() < 0.0).cast<int>();
}

std::optional<PointOnThreeLegs::Legs> PointOnThreeLegs::close_legs(const Configuration& pose,
                                                                   const WorkingMode& mode) const noexcept {
  const bool is_mode = mode.size() == n && (mode.array() == 0 || mode.array() == 1).all();
  if (!is_mode || !usable(pose, 2)) return std::nullopt;
  Legs legs;
  for (int i = 0; i < n; ++i) {
    PlanarLeg& leg = legs[index(i)];
    leg = close_leg(geometry_[index(i)], pose.head<2>(), Eigen::Vector2d::UnitX(), 1.0 - 2.0 * mode[i]);
    if (!leg.reachable) return std::nullopt;
  }
  return legs;
}

JointAngles PointOnThreeLegs::joint_angles(const Legs& legs) const noexcept {
  JointAngles angles{JointVector(n), JointVector(n), JointVector(0)};
  for (int i = 0; i < n; ++i) {
    angles.active[i] = active_angle(geometry_[index(i)], legs[index(i)]);
    angles.passive[i] = passive_angle(legs[index(i)]);
  }
  return angles;
}

// ---------------------------------------------------------------- inverse and forward kinematics

InverseSolution PointOnThreeLegs::inverse_kinematics(const Configuration& pose,
                                                     const WorkingMode& mode) const noexcept {
  const auto legs = close_legs(pose, mode);
  if (!legs) return {{JointVector::Zero(n), JointVector::Zero(n), JointVector(0)}, false};
  return {joint_angles(*legs), true};
}

// Gauss-Newton on the circles about the elbows; then the angles tell whether the elbows are on their sides.
ForwardSolution PointOnThreeLegs::forward_kinematics(const JointVector& active, const Configuration& start,
                                                     const WorkingMode& mode) const noexcept {
  ForwardSolution solution{home_pose(), 0, false};
  if (!usable(active, n) || !close_legs(start, mode)) return solution;
  Eigen::Vector2d point = start;
  double last_step = 1.0;
  while (last_step > smallest_step && solution.iterations < 10) {
    Map A;
    Eigen::Vector3d missed;
    for (int i = 0; i < n; ++i) {
      const PlanarLegGeometry& g = geometry_[index(i)];
      const Eigen::Vector2d elbow = g.base_joint + g.link1_length * unit_vector(g.base_angle + active[i]);
      A.row(i) = (point - elbow).normalized();
      missed[i] = g.link2_length - (point - elbow).norm();
    }
    const Eigen::Vector2d step = (A.transpose() * A).inverse() * (A.transpose() * missed);
    if (!usable(step, 2)) return solution;
    point += step;
    last_step = step.norm();
    ++solution.iterations;
  }
  const auto legs = close_legs(point, mode);
  if (!legs) return solution;
  solution.pose = point;
  const double missed = drive_difference(active, joint_angles(*legs).active).lpNorm<Eigen::Infinity>();
  solution.converged = last_step <= smallest_step && missed < largest_disagreement;
  return solution;
}

Configuration PointOnThreeLegs::start_pose(const JointVector& active,
                                           const JointVector& passive) const noexcept {
  if (!usable(active, n) || !usable(passive, n)) return home_pose();
  Eigen::Vector2d sum(0.0, 0.0);
  for (int i = 0; i < n; ++i) sum += chain_tip(geometry_[index(i)], active[i], passive[i]);
  return Eigen::Vector2d(sum / n);
}

double PointOnThreeLegs::chain_closure_error(const JointVector& active, const JointVector& passive,
                                             const Configuration& pose) const noexcept {
  if (!usable(active, n) || !usable(passive, n) || !usable(pose, 2)) {
    return std::numeric_limits<double>::infinity();
  }
  double error = 0.0;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2d tip = chain_tip(geometry_[index(i)], active[i], passive[i]);
    error = std::max(error, (tip - pose.head<2>()).lpNorm<Eigen::Infinity>());
  }
  return error;
}

// ---------------------------------------------------------------- differential kinematics, dynamics

void PointOnThreeLegs::kinematics(const Configuration& pose, const PlatformVector& velocity,
                                  const WorkingMode& mode, Kinematics& out) const noexcept {
  const auto legs = usable(velocity, 2) ? close_legs(pose, mode) : std::nullopt;
  if (!legs) return set_unreachable(space(), joints, out);

  const Eigen::Vector2d x = pose;  // which may be part of `out`
  const Eigen::Vector2d v = velocity;
  set_unreachable(space(), joints, out);
  out.pose = x;
  out.velocity = v;
  out.joints = joint_angles(*legs);
  out.det_B = 1.0;
  Map J, dJ, A;
  for (int i = 0; i < n; ++i) {
    const PlanarLegGeometry& geometry = geometry_[index(i)];
    const PlanarLeg& closed = (*legs)[index(i)];
    const PlanarLegMotion motion = leg_motion(geometry, closed, {v[0], v[1], 0.0});
    const PlanarLegJacobianRate rate = leg_jacobian_rate(geometry, motion, 0.0);
    const double B = -2.0 * geometry.link1_length * geometry.link2_length * closed.sin_qp;
    J.row(i) = motion.J_qa.head<2>();
    dJ.row(i) = rate.dJ_qa.head<2>();
    A.row(i) = -B * J.row(i);
    out.J_qp_x.row(i) = (motion.J_theta2 - motion.J_qa).head<2>();
    out.dJ_qp_x.row(i) = (rate.dJ_theta2 - rate.dJ_qa).head<2>();
    out.rates.active[i] = motion.qa_rate;
    out.rates.passive[i] = motion.theta2_rate - motion.qa_rate;
    out.legs[index(i)] = {closed.base_joint, closed.passive_joint, closed.coupling_joint};
    out.det_B *= B;
  }
  out.J_qa_x = J;
  out.dJ_qa_x = dJ;
  out.det_A = std::sqrt(std::max(0.0, (A.transpose() * A).determinant()));
  const Eigen::Vector2d values = J.jacobiSvd().singularValues();
  out.sigma_kappa = values[1] > 0.0 ? values[0] / values[1] : std::numeric_limits<double>::infinity();
  out.reachable = true;
  out.valid = out.sigma_kappa < 1e6;
  if (out.valid) {
    // J^+ = (J^T J)^-1 J^T, and its derivative.
    const Eigen::Matrix2d G = (J.transpose() * J).inverse();
    const Inverse J_x = G * J.transpose();
    const Eigen::Matrix3d outside = Eigen::Matrix3d::Identity() - J * J_x;
    out.J_x_qa = J_x;
    out.dJ_x_qa = G * dJ.transpose() * outside - J_x * dJ * J_x;
  }
  if (!all_finite(out)) set_unreachable(space(), joints, out);
}

void PointOnThreeLegs::dynamics(const Kinematics& kinematics, Dynamics& out) const noexcept {
  if (!kinematics.reachable || kinematics.pose.size() != 2 || drive_count(kinematics) != n) {
    return set_invalid(2, out);
  }
  PlanarDynamics<2> sum;
  sum.M.diagonal().setConstant(parameters_.platform_mass);
  for (int i = 0; i < n; ++i) sum.add_leg(parameters_.legs[index(i)], friction_velocity, kinematics, i);
  sum.write(out);
}

DryFriction PointOnThreeLegs::dry_friction(int drive) const noexcept {
  return {.effort = parameters_.legs[index(drive)].active_friction.coulomb, .velocity = friction_velocity};
}

std::shared_ptr<const Mechanism> PointOnThreeLegs::deviating(const RobotDeviation& deviation) const {
  Parameters robot = parameters_;
  for (std::size_t i = 0; i < n; ++i) robot.legs[i] = deviating_leg(robot.legs[i], deviation, i);
  robot.platform_mass = robot.platform_mass * deviation.platform_inertia_scale + deviation.payload;
  return std::make_shared<const PointOnThreeLegs>(robot);
}

CartesianVector PointOnThreeLegs::point_on_body(const Kinematics& kinematics, BodyId body,
                                                const CartesianVector& point_in_body) const noexcept {
  return planar_point_on_body<2>(kinematics, n, body, point_in_body);
}

ContactJacobian PointOnThreeLegs::contact_jacobian(const Kinematics& kinematics, BodyId body,
                                                   const CartesianVector& point_in_body) const noexcept {
  return planar_contact_jacobian<2>(kinematics, n, body, point_in_body);
}

// ---------------------------------------------------------------- parameters

std::vector<std::string> problems(const PointOnThreeLegs::Parameters& parameters) {
  Findings findings;
  findings.positive("platform_mass", parameters.platform_mass, "kg");
  findings.finite("home_pose", parameters.home_pose, "m");
  for (std::size_t i = 0; i < parameters.legs.size(); ++i) {
    const std::string path = "legs[" + std::to_string(i) + "].";
    find_problems(path, parameters.legs[i], findings);
    findings.finite(path + "base_joint", parameters.legs[i].base_joint, "m");
  }
  if (!findings.none()) return findings.take();
  for (std::size_t i = 0; i < parameters.legs.size(); ++i) {
    const FiveBarLeg& leg = parameters.legs[i];
    find_reach_problem(i, leg, (parameters.home_pose - leg.base_joint).norm(), findings);
  }
  return findings.take();
}

PointOnThreeLegs::Parameters point_on_three_legs() {
  const FiveBarParameters five_bar = five_bar_robot(FiveBarElbows::outward);
  PointOnThreeLegs::Parameters robot{.legs = {five_bar.legs[0], five_bar.legs[1], five_bar.legs[0]},
                                     .platform_mass = five_bar.platform_mass,
                                     .home_pose = five_bar.home_pose};
  robot.legs[2].base_joint = {0.02, 0.67};
  return robot;
}
