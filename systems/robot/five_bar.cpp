#include "systems/robot/five_bar.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/planar_contact.h"
#include "systems/robot/planar_leg_dynamics.h"

namespace flinch {
namespace {

constexpr double largest_angle_error = 1e-10;  // [rad]
// Beyond this, inverting J_qa_x leaves less than ten digits.
constexpr double largest_condition_number = 1e6;

constexpr JointCounts joints{.active = 2, .passive = 2, .coupling = 0};

MechanismDescription describe(const FiveBarParameters& parameters) {
  throw_if_any(problems(parameters));
  const int first = BodyId::link1(0).index();
  const int other_first = BodyId::link1(1).index();
  return {.name = parameters.name,
          .space = ConfigurationSpace::Kind::plane,
          .drives = std::vector<DriveKind>(2, DriveKind::revolute),
          .bodies = planar_bodies(parameters.platform_radius, parameters.legs, parameters.link_radius),
          // The second links always meet.
          .self_collision_pairs = {{first, other_first},
                                   {first, BodyId::link2(1).index()},
                                   {BodyId::link2(0).index(), other_first}},
          .gravity = parameters.gravity,
          .home_pose = parameters.home_pose};
}

double elbow_sign(const WorkingMode& mode, int leg) { return 1.0 - 2.0 * mode[leg]; }

bool is_working_mode(const WorkingMode& mode) {
  return mode.size() == 2 && (mode.array() == 0 || mode.array() == 1).all();
}

// On which side of the line from elbow to elbow the legs meet; 0 at a type-II singularity.
double assembly(const std::array<PlanarLeg, 2>& legs) { return cross(legs[0].u2, legs[1].u2); }

// cond_2: from the sum and the difference of the singular values.
double condition_number(const Eigen::Matrix2d& J) {
  const double squares = J.squaredNorm();
  const double product = std::abs(J.determinant());
  const double sum = std::sqrt(squares + 2.0 * product);
  const double difference = std::sqrt(std::max(squares - 2.0 * product, 0.0));
  const double largest = 0.5 * (sum + difference);
  return product > 0.0 ? largest * largest / product : std::numeric_limits<double>::infinity();
}

// Where the second links meet, in closed form: circles about both elbows. Not finite where they do not.
Eigen::Vector2d meeting_point(const std::array<PlanarLegGeometry, 2>& geometry, const JointVector& active,
                              double assembly) {
  const auto elbow = [&](int leg) -> Eigen::Vector2d {
    const PlanarLegGeometry& g = geometry[static_cast<std::size_t>(leg)];
    return g.base_joint + g.link1_length * unit_vector(g.base_angle + active[leg]);
  };
  const double r1 = geometry[0].link2_length;
  const double r2 = geometry[1].link2_length;
  const Eigen::Vector2d from = elbow(0);
  const Eigen::Vector2d D = elbow(1) - from;
  const double distance = D.norm();
  const double along = (r1 * r1 - r2 * r2 + distance * distance) / (2.0 * distance);
  const double across = std::copysign(std::sqrt(r1 * r1 - along * along), assembly);
  return from + rotate(D / distance, {along, across});
}

}  // namespace

FiveBar::FiveBar(const FiveBarParameters& parameters)
    : ParallelRobot(describe(parameters)), parameters_(parameters) {
  for (std::size_t i = 0; i < 2; ++i) {
    geometry_[i] = leg_geometry(parameters.legs[i], parameters.legs[i].base_joint, Eigen::Vector2d::Zero());
  }
}

WorkingMode FiveBar::home_working_mode() const noexcept {
  WorkingMode mode(2);
  for (int i = 0; i < 2; ++i) mode[i] = parameters_.legs[static_cast<std::size_t>(i)].elbow_sign > 0 ? 0 : 1;
  return mode;
}

WorkingMode FiveBar::working_mode(const JointVector& passive) const noexcept {
  if (!usable(passive, 2)) return home_working_mode();
  return (passive.array() < 0.0).cast<int>();
}

// Nothing out of reach, and for input that is none.
std::optional<FiveBar::Legs> FiveBar::close_legs(const Eigen::Vector2d& point,
                                                 const WorkingMode& mode) const noexcept {
  if (!is_working_mode(mode) || !usable(point, 2)) return std::nullopt;
  Legs legs;
  for (int i = 0; i < 2; ++i) {
    const auto leg = static_cast<std::size_t>(i);
    legs[leg] = close_leg(geometry_[leg], point, Eigen::Vector2d::UnitX(), elbow_sign(mode, i));
    if (!legs[leg].reachable) return std::nullopt;
  }
  return legs;
}

JointAngles FiveBar::joint_angles(const Legs& legs) const noexcept {
  JointAngles angles{JointVector(2), JointVector(2), JointVector(0)};
  for (int i = 0; i < 2; ++i) {
    const auto leg = static_cast<std::size_t>(i);
    angles.active[i] = active_angle(geometry_[leg], legs[leg]);
    angles.passive[i] = passive_angle(legs[leg]);
  }
  return angles;
}

// ---------------------------------------------------------------- inverse and forward kinematics

InverseSolution FiveBar::inverse_kinematics(const Configuration& pose,
                                            const WorkingMode& mode) const noexcept {
  InverseSolution solution{{JointVector::Zero(2), JointVector::Zero(2), JointVector(0)}, false};
  if (pose.size() != 2) return solution;
  const auto legs = close_legs(pose, mode);
  if (!legs) return solution;
  return {joint_angles(*legs), true};
}

// The drive angles at the point found tell whether the elbows are on their sides there.
ForwardSolution FiveBar::forward_kinematics(const JointVector& active, const Configuration& start,
                                            const WorkingMode& mode) const noexcept {
  ForwardSolution solution{home_pose(), 0, false};
  if (!usable(active, 2) || start.size() != 2) return solution;
  const auto legs_at_start = close_legs(start, mode);
  if (!legs_at_start) return solution;

  const Eigen::Vector2d point = meeting_point(geometry_, active, assembly(*legs_at_start));
  const auto legs = close_legs(point, mode);
  if (!legs) return solution;
  const JointVector error = drive_difference(active, joint_angles(*legs).active);
  const bool same_elbows = error.lpNorm<Eigen::Infinity>() < largest_angle_error;
  return {point, 1, same_elbows, !same_elbows};
}

Configuration FiveBar::start_pose(const JointVector& active, const JointVector& passive) const noexcept {
  if (!usable(active, 2) || !usable(passive, 2)) return home_pose();
  return Eigen::Vector2d(0.5 * (chain_tip(geometry_[0], active[0], passive[0]) +
                                chain_tip(geometry_[1], active[1], passive[1])));
}

double FiveBar::chain_closure_error(const JointVector& active, const JointVector& passive,
                                    const Configuration& pose) const noexcept {
  if (!usable(active, 2) || !usable(passive, 2) || !usable(pose, 2)) {
    return std::numeric_limits<double>::infinity();
  }
  double error = 0.0;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d tip = chain_tip(geometry_[static_cast<std::size_t>(i)], active[i], passive[i]);
    error = std::max(error, (tip - pose.head<2>()).lpNorm<Eigen::Infinity>());
  }
  return error;
}

// ---------------------------------------------------------------- differential kinematics, dynamics

// Rows of the legs without their third column: a point has no arm and does not turn.
void FiveBar::kinematics(const Configuration& pose, const PlatformVector& velocity, const WorkingMode& mode,
                         Kinematics& out) const noexcept {
  if (pose.size() != 2 || !usable(velocity, 2)) return set_unreachable(space(), joints, out);
  const auto legs = close_legs(pose, mode);
  if (!legs) return set_unreachable(space(), joints, out);

  const Eigen::Vector2d x = pose;  // which may be part of `out`
  const Eigen::Vector2d v = velocity;
  set_unreachable(space(), joints, out);
  out.pose = x;
  out.velocity = v;
  out.joints = joint_angles(*legs);
  out.det_B = 1.0;
  for (int i = 0; i < 2; ++i) {
    const auto leg = static_cast<std::size_t>(i);
    const PlanarLegGeometry& geometry = geometry_[leg];
    const PlanarLeg& closed = (*legs)[leg];
    const PlanarLegMotion motion = leg_motion(geometry, closed, {v[0], v[1], 0.0});
    const PlanarLegJacobianRate rate = leg_jacobian_rate(geometry, motion, 0.0);
    out.J_qa_x.row(i) = motion.J_qa.head<2>();
    out.J_qp_x.row(i) = (motion.J_theta2 - motion.J_qa).head<2>();
    out.dJ_qa_x.row(i) = rate.dJ_qa.head<2>();
    out.dJ_qp_x.row(i) = (rate.dJ_theta2 - rate.dJ_qa).head<2>();
    out.rates.active[i] = motion.qa_rate;
    out.rates.passive[i] = motion.theta2_rate - motion.qa_rate;
    out.legs[leg] = {closed.base_joint, closed.passive_joint, closed.coupling_joint};
    out.det_B *= -2.0 * geometry.link1_length * geometry.link2_length * closed.sin_qp;
  }
  const Eigen::Matrix2d J_qa = out.J_qa_x;
  const Eigen::Matrix2d dJ_qa = out.dJ_qa_x;
  out.det_A = out.det_B * J_qa.determinant();  // A = -B J_qa
  out.sigma_kappa = condition_number(J_qa);
  out.reachable = true;
  out.valid = out.sigma_kappa < largest_condition_number;
  if (out.valid) {
    const Eigen::Matrix2d J_x = J_qa.inverse();
    out.J_x_qa = J_x;
    out.dJ_x_qa = -J_x * dJ_qa * J_x;
  }
  if (!all_finite(out)) set_unreachable(space(), joints, out);
}

void FiveBar::dynamics(const Kinematics& kinematics, Dynamics& out) const noexcept {
  if (!kinematics.reachable || kinematics.pose.size() != 2) return set_invalid(2, out);
  PlanarDynamics<2> sum;
  sum.M.diagonal().setConstant(parameters_.platform_mass);
  for (int i = 0; i < 2; ++i) {
    sum.add_leg(parameters_.legs[static_cast<std::size_t>(i)], parameters_.friction_velocity, kinematics, i);
  }
  sum.write(out);
}

std::shared_ptr<const ParallelRobot> FiveBar::assembled_as(const WorkingMode& mode) const {
  if (!is_working_mode(mode)) return nullptr;
  FiveBarParameters robot = parameters_;
  for (int i = 0; i < 2; ++i) robot.legs[static_cast<std::size_t>(i)].elbow_sign = mode[i] == 0 ? 1 : -1;
  return std::make_shared<const FiveBar>(robot);
}

DryFriction FiveBar::dry_friction(int drive) const noexcept {
  const double coulomb = parameters_.legs[static_cast<std::size_t>(drive)].active_friction.coulomb;
  return {.effort = coulomb, .velocity = parameters_.friction_velocity};
}

std::shared_ptr<const Mechanism> FiveBar::deviating(const RobotDeviation& deviation) const {
  FiveBarParameters robot = parameters_;
  for (std::size_t i = 0; i < 2; ++i) robot.legs[i] = deviating_leg(robot.legs[i], deviation, i);
  robot.platform_mass = robot.platform_mass * deviation.platform_inertia_scale + deviation.payload;
  return std::make_shared<const FiveBar>(robot);
}

CartesianVector FiveBar::point_on_body(const Kinematics& kinematics, BodyId body,
                                       const CartesianVector& point_in_body) const noexcept {
  return planar_point_on_body<2>(kinematics, 2, body, point_in_body);
}

ContactJacobian FiveBar::contact_jacobian(const Kinematics& kinematics, BodyId body,
                                          const CartesianVector& point_in_body) const noexcept {
  return planar_contact_jacobian<2>(kinematics, 2, body, point_in_body);
}

}  // namespace flinch
