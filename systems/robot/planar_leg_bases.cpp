#include "systems/robot/planar_leg_bases.h"

#include <array>
#include <cstddef>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/joint_friction.h"
#include "systems/robot/planar_leg.h"

namespace flinch {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// One leg as it moves.
struct MovingLeg {
  const PlanarRrrLeg& model;
  double first_moment;      // m1 s1 + m2 l1
  Vector2d u1, u2, n1, n2;  // along and across the links
  Vector2d rates;           // of theta1, theta2
  double c, s;              // of theta2 - theta1

  MovingLeg(const PlanarRrrLeg& leg, double moment, const Kinematics& at, int i)
      : model(leg), first_moment(moment) {
    const LegPoints& points = at.legs[static_cast<std::size_t>(i)];
    u1 = (points.passive_joint - points.base_joint).head<2>() / leg.link1_length;
    u2 = (points.coupling_joint - points.passive_joint).head<2>() / leg.link2_length;
    n1 = normal(u1);
    n2 = normal(u2);
    rates << at.rates.active[i], at.rates.active[i] + at.rates.passive[i];
    c = u1.dot(u2);
    s = cross(u1, u2);
  }

  double second_moment() const { return model.inertia.p3 / model.link1_length; }  // m2 s2
  /// J_q^T, of the coupling joint: torques on (theta1, theta2) of a force there.
  Matrix2d torques_of_force() const {
    Matrix2d of;
    of.row(0) = model.link1_length * n1.transpose();
    of.row(1) = model.link2_length * n2.transpose();
    return of;
  }
  Matrix2d torques_of_force_rate() const {
    Matrix2d of;
    of.row(0) = -model.link1_length * rates[0] * u1.transpose();
    of.row(1) = -model.link2_length * rates[1] * u2.transpose();
    return of;
  }
  Matrix2d mass_matrix() const {
    const double mixed = model.inertia.p3 * c;
    Matrix2d M;
    M << model.inertia.p1 - model.inertia.p2 + model.rotor_inertia, mixed, mixed, model.inertia.p2;
    return M;
  }
  /// dT/d(theta1, theta2)
  Vector2d centrifugal() const {
    const double of = model.inertia.p3 * s * rates[0] * rates[1];
    return {of, -of};
  }
  Vector2d joint_torques(double drive, double friction_velocity) const {
    const double active = friction_effort(model.active_friction, rates[0], friction_velocity);
    const double passive = friction_effort(model.passive_friction, rates[1] - rates[0], friction_velocity);
    return {drive - active + passive, -passive};
  }
  /// Torques on (theta1, theta2) of a force on a link.
  Vector2d torques_of(BodyId link, const Vector2d& arm_from_base, const Vector2d& force) const {
    if (link.is_link1()) return {cross(arm_from_base, force), 0.0};
    const Vector2d elbow = model.link1_length * u1;
    return {model.link1_length * n1.dot(force), cross(arm_from_base - elbow, force)};
  }
  Vector2d linear_momentum() const { return first_moment * rates[0] * n1 + second_moment() * rates[1] * n2; }
  Vector2d linear_momentum_rate(const Vector2d& accelerations) const {
    return first_moment * (accelerations[0] * n1 - rates[0] * rates[0] * u1) +
           second_moment() * (accelerations[1] * n2 - rates[1] * rates[1] * u2);
  }
};

/// Accelerations of theta1 and theta2 of leg `i`.
Vector2d joint_accelerations(const Kinematics& at, const PlatformVector& acceleration, int i) {
  const auto of = [&](const PlatformMatrix& J, const PlatformMatrix& dJ) {
    return J.row(i).dot(acceleration) + dJ.row(i).dot(at.velocity);
  };
  const double active = of(at.J_qa_x, at.dJ_qa_x);
  return {active, active + of(at.J_qp_x, at.dJ_qp_x)};
}

Vector2d arm(const Kinematics& at, int leg, const CartesianVector& point) {
  return (point - at.legs[static_cast<std::size_t>(leg)].base_joint).head<2>();
}

}  // namespace

PlanarLegBases::PlanarLegBases(std::shared_ptr<const PlanarRrr> robot,
                               const std::array<double, 3>& first_moments)
    : robot_(std::move(robot)), first_moments_(first_moments) {}

// Y = (1; -J_q^-1): p_b = P - J_q^-T M dq, and of J_q^-T d/dt = -J_q^-T dJ_q^T J_q^-T.
void PlanarLegBases::momentum(const Kinematics& at, const JointVector& torque, BaseForces& p,
                              BaseForces& s) const noexcept {
  p.setZero(size());
  s.setZero(size());
  const PlanarRrrParameters& robot = robot_->parameters();
  for (int i = 0; i < legs(); ++i) {
    const auto index = static_cast<std::size_t>(i);
    const MovingLeg leg(robot.legs[index], first_moments_[index], at, i);
    const auto J_T = leg.torques_of_force().partialPivLu();
    const Vector2d at_coupling = J_T.solve(leg.mass_matrix() * leg.rates);
    const Vector2d torques = leg.joint_torques(torque[i], robot.friction_velocity) + leg.centrifugal();
    p.segment<2>(2 * i) = leg.linear_momentum() - at_coupling;
    s.segment<2>(2 * i) = J_T.solve(leg.torques_of_force_rate() * at_coupling - torques);
  }
}

CartesianVector PlanarLegBases::felt(const Kinematics& at, BodyId body, const CartesianVector& point_in_base,
                                     const CartesianVector& force_in_base) const noexcept {
  if (body.is_platform()) return CartesianVector::Zero(2);
  const int i = body.leg();
  const auto index = static_cast<std::size_t>(i);
  const MovingLeg leg(robot_->parameters().legs[index], first_moments_[index], at, i);
  const Vector2d force = force_in_base.head<2>();
  const Vector2d torques = leg.torques_of(body, arm(at, i, point_in_base), force);
  return force - leg.torques_of_force().partialPivLu().solve(torques);
}

// Leg by leg: the coupling force from the torques on the joints, then the balance of linear momentum.
void PlanarLegBases::forces(const Kinematics& at, const PlatformVector& acceleration,
                            const JointVector& torque, std::span<const ForceOnBody> contacts,
                            BaseForces& out) const noexcept {
  out.setZero(size());
  const PlanarRrrParameters& robot = robot_->parameters();
  for (int i = 0; i < legs(); ++i) {
    const auto index = static_cast<std::size_t>(i);
    const MovingLeg leg(robot.legs[index], first_moments_[index], at, i);
    Vector2d torques = leg.joint_torques(torque[i], robot.friction_velocity);
    Vector2d touched = Vector2d::Zero();
    for (const ForceOnBody& contact : contacts) {
      const BodyId body = BodyId::from_index(contact.body);
      if (body.is_platform() || body.leg() != i) continue;
      const Vector2d force = contact.force_in_base.head<2>();
      torques += leg.torques_of(body, arm(at, i, contact.point_in_base), force);
      touched += force;
    }
    const Vector2d accelerations = joint_accelerations(at, acceleration, i);
    const double of_turning = leg.model.inertia.p3 * leg.s;  // M dq' + (-p3 s q2'^2, p3 s q1'^2)
    const Vector2d inertial =
        leg.mass_matrix() * accelerations +
        of_turning * Vector2d(-leg.rates[1] * leg.rates[1], leg.rates[0] * leg.rates[0]);
    const Vector2d on_platform = leg.torques_of_force().partialPivLu().solve(torques - inertial);
    out.segment<2>(2 * i) = leg.linear_momentum_rate(accelerations) + on_platform - touched;
  }
}

/// Other mechanisms have no such model yet.
std::shared_ptr<const LegBases> leg_bases(const std::shared_ptr<const Mechanism>& robot,
                                          const JointVector& first_moments, const Mechanism& believed) {
  const auto planar = std::dynamic_pointer_cast<const PlanarRrr>(robot);
  const auto* const model = dynamic_cast<const PlanarRrr*>(&believed);
  if (!planar || model == nullptr)
    throw SetupError("base forces: only a robot of the kind planar_3rrr has a model of its base joints");
  if (!usable(first_moments, 3) || !(first_moments.array() > 0.0).all())
    throw SetupError("base forces: first_moment needs a positive number for each of the 3 legs [kg m]");
  std::array<double, 3> moments{};
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const double heavier = planar->parameters().legs[i].inertia.p1 / model->parameters().legs[i].inertia.p1;
    moments[i] = heavier * first_moments[static_cast<Eigen::Index>(i)];
  }
  return std::make_shared<const PlanarLegBases>(planar, moments);
}

}  // namespace flinch
