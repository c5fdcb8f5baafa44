#include "systems/contact/leg_history.h"

#include <cmath>

#include "systems/contact/wrench_uncertainty.h"

namespace flinch {
namespace {

/// Times a velocity of the platform: that of the middle of a link along `direction`.
PlatformVector motion_of(const ParallelRobot& robot, const Kinematics& now, BodyId link,
                         const CartesianVector& direction) {
  return robot.contact_jacobian(now, link, robot.axis_point(link, 0.5)).translation.transpose() * direction;
}

/// Of length 1; zero where `vector` is shorter than `least`.
PlatformVector normalised(const PlatformVector& vector, double least) {
  const double size = vector.norm();
  return size > least ? PlatformVector(vector / size) : PlatformVector(PlatformVector::Zero(vector.size()));
}

LegHistory leg_history(const ParallelRobot& robot, const Kinematics& now, const PlatformVector& deviation,
                       const ContactMoments& moments, int leg) {
  LegHistory result;
  const LegPoints& points = now.legs[static_cast<std::size_t>(leg)];
  const CartesianVector first = points.base_joint - points.passive_joint;
  const CartesianVector second = points.coupling_joint - points.passive_joint;
  const double lengths = first.norm() * second.norm();
  if (!(lengths > 0.0)) return result;
  const double cosine = first.dot(second) / lengths;
  if (!(std::abs(cosine) < 1.0 - 1e-6)) return result;
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const CartesianVector along1 = first / first.norm(), along2 = second / second.norm();
  const CartesianVector inwards1 = (along2 - cosine * along1) / sine;
  const CartesianVector inwards2 = (along1 - cosine * along2) / sine;
  const PlatformVector motion1 = motion_of(robot, now, BodyId::link1(leg), inwards1);
  const PlatformVector motion2 = motion_of(robot, now, BodyId::link2(leg), inwards2);
  // What pushes the links apart pushes them outwards.
  const PlatformVector push1 = normalised(-motion1.cwiseQuotient(deviation), 0.0);
  const PlatformVector push2 = -motion2.cwiseQuotient(deviation);
  const PlatformVector beside = normalised(push2 - push1.dot(push2) * push1, 1e-6 * push2.norm());
  result.elbow_cosine = cosine;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const PlatformVector wrench = moments[i].wrench_in_base.cwiseQuotient(deviation);
    LegMoment& moment = result.moments[i];
    moment.link1_force = push1.dot(wrench);
    moment.link2_force = beside.dot(wrench);
    moment.other_force = (wrench - moment.link1_force * push1 - moment.link2_force * beside).norm();
    moment.link1_speed = motion1.dot(moments[i].velocity);
    moment.link2_speed = motion2.dot(moments[i].velocity);
  }
  return result;
}

}  // namespace

std::optional<LegCourses> leg_histories(const ParallelRobot& robot, const Kinematics& now,
                                        const ContactMoments& moments) noexcept {
  const int dof = robot.dof();
  if (!now.valid) return std::nullopt;
  for (const ContactMoment& moment : moments)
    if (moment.wrench_in_base.size() != dof || moment.velocity.size() != dof) return std::nullopt;
  LegCourses courses{};
  const PlatformVector deviation = WrenchUncertainty().deviation_without_contact(robot.space());
  for (int leg = 0; leg < robot.legs(); ++leg)
    courses[static_cast<std::size_t>(leg)] = leg_history(robot, now, deviation, moments, leg);
  return courses;
}

}  // namespace flinch
