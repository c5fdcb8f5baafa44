#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "systems/robot/angles.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/legs/legs_assembly.h"
#include "systems/robot/legs/legs_motion.h"
#include "systems/robot/legs/legs_robot.h"

namespace flinch {
namespace {

constexpr int max_iterations = 10;
constexpr double largest_drive_error = 1e-10;  // [rad or m]
constexpr double largest_last_step = 1e-8;     // [m, rad]
constexpr double last_redundant_step = 1e-9;   // of more drives than coordinates, which never agree quite
constexpr double largest_disagreement = 1e-3;  // [rad or m]
// Beyond this, inverting the drive map leaves less than ten digits.
constexpr double largest_condition_number = 1e6;
// A leg nearer to a type-I singularity, by the determinant at home, is not told to reach.
constexpr double least_leg_determinant = 1e-10;

// det A, or the root of det A^T A of more drives than coordinates.
template <class Matrix>
double determinant(const Matrix& A) {
  if (A.rows() == A.cols()) return A.determinant();
  const PlatformMatrix squared = A.transpose().lazyProduct(A);
  return std::sqrt(std::max(0.0, squared.determinant()));
}

// Infinite if A is singular to working precision.
template <class Squared>
double condition_number(const Squared& A_squared) {
  const Eigen::SelfAdjointEigenSolver<Squared> solver(A_squared, Eigen::EigenvaluesOnly);
  const double smallest = solver.eigenvalues()[0];
  const double largest = solver.eigenvalues()[A_squared.cols() - 1];
  const bool regular = smallest > std::numeric_limits<double>::epsilon() * largest;
  return regular ? std::sqrt(largest / smallest) : std::numeric_limits<double>::infinity();
}

// What follows from the drive map, for `m` drives and `n` coordinates or any number of them.
template <int m, int n>
void set_inverse(const PlatformVector& scale, Kinematics& out) {
  constexpr int max_m = m == Eigen::Dynamic ? max_dof : m;
  constexpr int max_n = n == Eigen::Dynamic ? max_dof : n;
  using Map = Eigen::Matrix<double, m, n, 0, max_m, max_n>;
  using Square = Eigen::Matrix<double, n, n, 0, max_n, max_n>;
  using Inverse = Eigen::Matrix<double, n, m, 0, max_n, max_m>;
  const Map A = out.J_qa_x;
  const Map dA = out.dJ_qa_x;
  const Map scaled = A * scale.asDiagonal();
  const Square squared = scaled.transpose().lazyProduct(scaled);
  out.det_A *= determinant(A);
  out.sigma_kappa = condition_number(squared);
  out.valid = out.sigma_kappa < largest_condition_number;
  if (!out.valid) return;
  if constexpr (m == n && n != Eigen::Dynamic) {
    const Inverse J_x = A.inverse();
    out.J_x_qa = J_x;
    out.dJ_x_qa = -J_x * dA * J_x;
  } else {
    // A^+ = (A^T A)^-1 A^T and its derivative (A^T A)^-1 (dA^T - (dA^T A + A^T dA) A^+).
    const Square A_squared = A.transpose().lazyProduct(A);
    const Square G = A_squared.inverse();
    const Inverse J_x = G.lazyProduct(A.transpose());
    Square rate = A.transpose().lazyProduct(dA);
    rate += Square(rate.transpose());
    Inverse right = dA.transpose();
    right -= rate.lazyProduct(J_x);
    out.J_x_qa = J_x;
    out.dJ_x_qa = G.lazyProduct(right);
  }
}

void set_inverse(const PlatformVector& scale, Kinematics& out) {
  const Eigen::Index m = out.J_qa_x.rows();
  const Eigen::Index n = out.J_qa_x.cols();
  if (m == 2 && n == 2) return set_inverse<2, 2>(scale, out);
  if (m == 3 && n == 3) return set_inverse<3, 3>(scale, out);
  if (m == 6 && n == 6) return set_inverse<6, 6>(scale, out);
  set_inverse<Eigen::Dynamic, Eigen::Dynamic>(scale, out);
}

}  // namespace

WorkingMode LegsRobot::home_working_mode() const noexcept { return WorkingMode::Zero(legs()); }

// Of an arm all of whose joints but the first are measured: on which side of its singularity it is, which the
// first does not change.
WorkingMode LegsRobot::working_mode(const JointVector& passive) const noexcept {
  WorkingMode mode = home_working_mode();
  if (!usable(passive, passive_joints())) return mode;
  for (std::size_t i = 0; i < model_.legs.size(); ++i) {
    const ModelLeg& leg = model_.legs[i];
    if (!leg.form || !leg.form->is_arm()) continue;
    LegCoordinates s = leg.home;
    int seen = 0;
    for (std::size_t p = 0; p < model_.measured.size(); ++p) {
      const ChainJoint& joint = leg.chain.joints[model_.measured[p].joint];
      if (model_.measured[p].leg != i || joint.coordinate == 0) continue;
      s[joint.coordinate] = (passive[static_cast<Eigen::Index>(p)] - joint.offset) / joint.ratio;
      ++seen;
    }
    if (seen + 1 != leg.chain.coordinates) continue;
    ChainPlace place;
    ClosureMatrix J;
    ClosureFactor factor;
    leg.chain.place(s, place);
    leg.matrix(place, J);
    factor.compute(J);
    if (factor.determinant() * leg.home_determinant < 0.0) mode[static_cast<int>(i)] = 1;
  }
  return mode;
}

JointVector LegsRobot::passive_positions(const LegsState& state) const noexcept {
  JointVector positions(passive_joints());
  for (int i = 0; i < passive_joints(); ++i) {
    const JointOfLeg& of = model_.measured[static_cast<std::size_t>(i)];
    const ChainJoint& joint = model_.legs[of.leg].chain.joints[of.joint];
    const double q = joint.position(state.s[of.leg]);
    positions[i] = joint.slides ? q : wrap_angle(q);
  }
  return positions;
}

InverseSolution LegsRobot::inverse_kinematics(const Configuration& pose,
                                              const WorkingMode& mode) const noexcept {
  InverseSolution solution{{JointVector::Zero(drives()), JointVector::Zero(passive_joints()), JointVector(0)},
                           false};
  PlatformTwist platform;
  LegsState state;
  if (!is_usable(pose, mode) || !assemble(model_, pose, mode, platform, state)) return solution;
  solution.joints.active = drive_positions(model_, state);
  solution.joints.passive = passive_positions(state);
  solution.reachable = solution.joints.active.allFinite() && solution.joints.passive.allFinite();
  if (!solution.reachable) {
    solution.joints.active.setZero();
    solution.joints.passive.setZero();
  }
  return solution;
}

void LegsRobot::set_points(const LegsMotion& motion, Kinematics& out) const noexcept {
  const int directions = space_dimension();
  for (std::size_t i = 0; i < model_.legs.size(); ++i) {
    const ChainPlace& place = motion.legs[i].place;
    const auto at = [&](std::size_t body, const Eigen::Vector3d& point) {
      const std::size_t joint = model_.bodies[2 * i + body].joint;
      return CartesianVector((place.origin[joint] + place.axes[joint] * point).head(directions));
    };
    out.legs[i] = {at(0, ends_[i].base_joint), at(0, ends_[i].passive_joint), at(1, ends_[i].coupling_joint)};
  }
}

void LegsRobot::kinematics(const Configuration& pose, const PlatformVector& velocity, const WorkingMode& mode,
                           Kinematics& out) const noexcept {
  // Which may be part of `out`. NOLINTBEGIN(performance-unnecessary-copy-initialization)
  const Configuration x = pose;
  const PlatformVector v = velocity;
  // NOLINTEND(performance-unnecessary-copy-initialization)
  PlatformTwist platform;
  LegsState state;
  const bool reaches = usable(v, dof()) && is_usable(x, mode) && assemble(model_, x, mode, platform, state);
  set_unreachable(space(), joint_counts(), out);
  if (!reaches) return;

  LegsMotion motion;
  motion.set(model_, x, v, state);
  out.det_B = 1.0;
  for (std::size_t i = 0; i < model_.legs.size(); ++i) {
    const double of_leg = motion.legs[i].factor.determinant() / model_.legs[i].home_determinant;
    const double b = model_.legs[i].is_square() ? of_leg : std::abs(of_leg);
    if (!(std::abs(b) > least_leg_determinant)) return set_unreachable(space(), joint_counts(), out);
    out.det_B *= b;
  }
  out.pose = x;
  out.velocity = v;
  out.joints.active = drive_positions(model_, state);
  out.joints.passive = passive_positions(state);
  set_drive_map(model_, motion, out.J_qa_x, out.dJ_qa_x);
  for (int i = 0; i < passive_joints(); ++i) {
    const JointOfLeg& of = model_.measured[static_cast<std::size_t>(i)];
    const ChainJoint& joint = model_.legs[of.leg].chain.joints[of.joint];
    out.J_qp_x.row(i) = joint.ratio * motion.legs[of.leg].G.row(joint.coordinate);
    out.dJ_qp_x.row(i) = joint.ratio * motion.legs[of.leg].dG.row(joint.coordinate);
  }
  out.rates.active = out.J_qa_x.lazyProduct(v);
  out.rates.passive = out.J_qp_x.lazyProduct(v);
  for (std::size_t i = 0; i < model_.legs.size(); ++i) {
    const Eigen::Index before = out.searched.size();
    out.searched.conservativeResize(before + state.s[i].size());
    out.searched.tail(state.s[i].size()) = state.s[i];
  }
  out.searched.conservativeResize(out.searched.size() + state.z.size());
  out.searched.tail(state.z.size()) = state.z;
  set_points(motion, out);
  out.reachable = true;

  PlatformVector scale = PlatformVector::Ones(dof());
  scale.tail(space().rotations()).setConstant(1.0 / model_.characteristic_length);
  out.det_A = (drives() == dof() ? out.det_B : std::abs(out.det_B)) * motion.rest_determinant /
              model_.home_drive_determinant;
  set_inverse(scale, out);
  if (!all_finite(out) || !std::isfinite(out.det_A) || !std::isfinite(out.det_B))
    set_unreachable(space(), joint_counts(), out);
}

// ---------------------------------------------------------------- forward kinematics

// x <- x (+) A^+ (q - q(x)). The sign of det A tells whether the pose found is assembled as the start is.
ForwardSolution LegsRobot::forward_kinematics(const JointVector& active, const Configuration& start,
                                              const WorkingMode& mode) const noexcept {
  ForwardSolution solution{home_pose(), 0, false};
  if (!usable(active, drives()) || !is_usable(start, mode)) return solution;
  const bool redundant = drives() > dof();
  Configuration pose = start;
  double determinant_at_start = 0.0;
  bool met = false;
  while (!met && solution.iterations < max_iterations) {
    Kinematics k;
    kinematics(pose, PlatformVector::Zero(dof()), mode, k);
    if (!k.valid) break;
    const JointVector error = drive_difference(active, k.joints.active);
    const PlatformVector step = k.J_x_qa.lazyProduct(error);
    if (!step.allFinite() || step.tail(space().rotations()).norm() > std::numbers::pi) break;
    if (solution.iterations == 0) determinant_at_start = k.det_A;
    pose = space().plus(pose, step);
    ++solution.iterations;
    const double missed = error.lpNorm<Eigen::Infinity>();
    const double length = step.lpNorm<Eigen::Infinity>();
    met = redundant ? missed < largest_disagreement && length < last_redundant_step
                    : missed < largest_drive_error && length < largest_last_step;
    solution.converged = met && k.det_A * determinant_at_start > 0.0;
  }
  solution.other_branch = met && !solution.converged;
  if (!space().contains(pose)) {
    solution.converged = solution.other_branch = false;
    return solution;
  }
  solution.pose = pose;
  solution.converged = solution.converged && inverse_kinematics(pose, mode).reachable;
  return solution;
}

// ---------------------------------------------------------------- tips of legs by their encoders

std::optional<LegsRobot::Tip> LegsRobot::tip_of(std::size_t leg, const JointVector& active,
                                                const JointVector& passive) const noexcept {
  const ModelLeg& of = model_.legs[leg];
  if (of.closures.size() != 1 || of.closures.front().on != ChainClosure::On::platform) return std::nullopt;
  LegCoordinates s = of.home;
  int seen = 0;
  const auto see = [&](const JointOfLeg& place, double position) {
    if (place.leg != leg) return;
    const ChainJoint& joint = of.chain.joints[place.joint];
    s[joint.coordinate] = (position - joint.offset) / joint.ratio;
    ++seen;
  };
  for (std::size_t i = 0; i < model_.drives.size(); ++i) {
    const ModelDrive& drive = model_.drives[i];
    if (drive.terms.size() != 1) continue;
    see(drive.terms.front(),
        (active[static_cast<Eigen::Index>(i)] - drive.zero) / drive.terms.front().weight);
  }
  for (std::size_t i = 0; i < model_.measured.size(); ++i)
    see(model_.measured[i], passive[static_cast<Eigen::Index>(i)]);
  if (seen != of.chain.coordinates) return std::nullopt;
  ChainPlace place;
  of.chain.place(s, place);
  return Tip{of.closures.front().point(place), of.closures.front().on_at};
}

// The rigid motion that brings the points of the platform nearest to the tips.
Configuration LegsRobot::start_pose(const JointVector& active, const JointVector& passive) const noexcept {
  if (!usable(active, drives()) || !usable(passive, passive_joints()) || model_.following() > 0)
    return home_pose();
  std::array<Tip, max_dof> tips;
  std::size_t count = 0;
  for (std::size_t i = 0; i < model_.legs.size(); ++i) {
    if (const auto tip = tip_of(i, active, passive)) tips[count++] = *tip;
  }
  const int rotations = space().rotations();
  const std::size_t needed = rotations == 3 ? 3 : rotations == 1 ? 2 : 1;
  if (count < needed) return home_pose();
  const double share = 1.0 / static_cast<double>(count);
  Tip middle;
  for (std::size_t i = 0; i < count; ++i) {
    middle.held += share * tips[i].held;
    middle.on_platform += share * tips[i].on_platform;
  }
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < count; ++i)
    moment += (tips[i].held - middle.held) * (tips[i].on_platform - middle.on_platform).transpose();
  Eigen::Matrix3d R = model_.home_axes;
  Configuration pose = space().origin();
  if (rotations == 1) {
    const double angle = std::atan2(moment(1, 0) - moment(0, 1), moment(0, 0) + moment(1, 1));
    R = rotation_exp(angle * Eigen::Vector3d::UnitZ());
    pose[space().translations()] = angle;
  } else if (rotations == 3) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
    if (svd.singularValues()[1] < 1e-9) return home_pose();
    Eigen::Vector3d sign(1.0, 1.0, svd.matrixU().determinant() * svd.matrixV().determinant());
    R = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
    const Eigen::Quaterniond q(R);
    pose.tail<4>() << q.w(), q.x(), q.y(), q.z();
    pose.tail<4>().normalize();
  }
  const Eigen::Vector3d origin = middle.held - R * middle.on_platform;
  pose.head(space().translations()) = origin.head(space().translations());
  return space().contains(pose) ? pose : home_pose();
}

double LegsRobot::chain_closure_error(const JointVector& active, const JointVector& passive,
                                      const Configuration& pose) const noexcept {
  const bool all_usable = usable(active, drives()) && usable(passive, passive_joints()) &&
                          usable(pose, space().stored()) && space().contains(pose);
  if (!all_usable) return std::numeric_limits<double>::infinity();
  if (model_.following() > 0) return 0.0;
  PlatformTwist platform;
  model_.place(pose, FollowingVector(0), platform);
  double error = 0.0;
  for (std::size_t i = 0; i < model_.legs.size(); ++i) {
    const auto tip = tip_of(i, active, passive);
    if (!tip) continue;
    const Eigen::Vector3d missed = tip->held - platform.origin - platform.axes * tip->on_platform;
    error = std::max(error, missed.lpNorm<Eigen::Infinity>());
  }
  return error;
}

}  // namespace flinch
