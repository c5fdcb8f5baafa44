#include "systems/contact/contact_locator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/line_of_action.h"

namespace flinch {
namespace {

Eigen::Vector3d in_space(const CartesianVector& v) {
  Eigen::Vector3d spatial = Eigen::Vector3d::Zero();
  spatial.head(v.size()) = v;
  return spatial;
}

/// Axes of the platform in the base frame, as columns.
Eigen::Matrix3d platform_axes(const ParallelRobot& robot, const Kinematics& kinematics) {
  const int directions = robot.space_dimension();
  const CartesianVector origin =
      robot.point_on_body(kinematics, BodyId::platform(), CartesianVector::Zero(directions));
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  for (int axis = 0; axis < directions; ++axis) {
    const CartesianVector unit = CartesianVector::Unit(directions, axis);
    axes.col(axis) = in_space(robot.point_on_body(kinematics, BodyId::platform(), unit) - origin);
  }
  return axes;
}

/// Standard deviation of a line of action across itself: that of the moment about a point on it, over the
/// force. `arm`: from the platform's origin to that point.
double line_deviation(const ConfigurationSpace& space, const PlatformMatrix& covariance,
                      const Eigen::Vector3d& arm, double force) {
  const int directions = space.translations(), rotations = space.rotations();
  if (rotations == 0) return 0.0;
  PlatformMatrix about_line = PlatformMatrix::Identity(space.dimension(), space.dimension());
  for (int i = 0; i < directions; ++i) {
    const Eigen::Vector3d unit = in_space(CartesianVector::Unit(directions, i));
    about_line.col(i).tail(rotations) = -arm.cross(unit).tail(rotations);
  }
  const PlatformMatrix of_line = about_line * covariance * about_line.transpose();
  return std::sqrt(of_line.diagonal().tail(rotations).mean()) / force;
}

}  // namespace

ContactLocation locate_on_platform(const ParallelRobot& robot, const Kinematics& kinematics,
                                   const Outline& platform, const PlatformVector& wrench,
                                   const PlatformMatrix& covariance, double least_force) noexcept {
  ContactLocation location;
  const LineOfAction line = line_of_action(robot.space(), wrench, least_force);
  if (!line.valid || !kinematics.valid) return location;
  const int directions = robot.space_dimension();
  location.valid = true;
  location.body = BodyId::platform().index();
  location.force_in_base = wrench.head(directions);
  location.force_deviation =
      std::sqrt(line.direction.dot(covariance.topLeftCorner(directions, directions) * line.direction));
  const Eigen::Matrix3d axes = platform_axes(robot, kinematics);
  const Eigen::Vector3d origin = in_space(kinematics.pose.head(directions));
  const Eigen::Vector3d lever = axes.transpose() * in_space(line.lever);
  const Eigen::Vector3d direction = axes.transpose() * in_space(line.direction);
  const LinePassage passage = platform.passage(lever, direction);
  location.located = line.has_lever && passage.hits;
  Eigen::Vector3d point = lever + passage.enter * direction;  // the first of the two: a push
  if (!line.has_lever) point = platform.farthest(-direction);
  if (line.has_lever && !passage.hits) point = platform.farthest(lever.normalized());
  const Eigen::Vector3d arm = axes * point;
  location.point_in_base = (origin + arm).head(directions);
  location.point_deviation = line_deviation(robot.space(), covariance, arm, location.force_in_base.norm());
  return location;
}

CartesianVector pushed_point(const LinkContactMap& link, double fraction,
                             const CartesianVector& force) noexcept {
  const CartesianVector axis = link.axes.col(0);
  const CartesianVector across = force - force.dot(axis) * axis;
  const double size = across.norm();
  const CartesianVector on_axis = link.point(fraction);
  return size > 0.0 ? CartesianVector(on_axis - link.radius / size * across) : on_axis;
}

ContactLocation locate_on_link(const LinkContactMap& map, BodyId link, const PlatformVector& wrench,
                               const PlatformMatrix& noise, const PlatformMatrix& errors,
                               const ContactLocatorSettings& settings) noexcept {
  ContactLocation location;
  const LinkPush push = link_push(map, wrench, noise, settings.largest_deviation);
  if (!push.valid) return location;
  location.valid = true;
  location.body = link.index();
  location.fraction = std::clamp(push.fraction, 0.0, 1.0);
  location.force_in_base = push.force * map.axes.col(1);
  location.point_in_base = pushed_point(map, location.fraction, location.force_in_base);
  location.covariance = push.covariance;
  if (push.identifiable) {
    const CartesianVector across = Eigen::Vector2d(0.0, push.force);
    location.covariance = push_covariance(map, push.fraction, across, errors) +
                          lean_covariance(map, wrench, noise, push, settings.leaning);
  }
  const double deviation = std::sqrt(location.covariance(0, 0));
  location.located = push.identifiable && deviation <= settings.largest_deviation;
  location.point_deviation = map.length * deviation;
  location.force_deviation = std::sqrt(location.covariance(1, 1));
  location.residual = push.residual;
  return location;
}

ContactLocator::ContactLocator(std::shared_ptr<const ParallelRobot> robot,
                               const ContactLocatorSettings& settings, const WrenchUncertainty& uncertainty)
    : robot_(std::move(robot)),
      classes_(robot_->body_count(), robot_->legs()),
      platform_(robot_->body(BodyId::platform()).shapes),
      settings_(settings),
      uncertainty_(uncertainty) {
  Findings found("contact locator: ");
  found.positive("least_force", settings.least_force, "N");
  found.positive("largest_deviation", settings.largest_deviation);
  found.not_negative("leaning", settings.leaning);
  uncertainty.find_problems(found);
  throw_if_any(found.take());
}

ContactLocation ContactLocator::locate(const ContactPhase& contact, const ContactClassification& touched,
                                       const Kinematics& now, const WrenchEstimate& estimate,
                                       const WrenchEstimate& lately) const {
  ContactLocation found;
  const bool can_be_located = contact.active && touched.valid && classes_.contains(touched.most_likely) &&
                              !classes_.is_clamping(touched.most_likely) && estimate.valid && now.valid &&
                              usable(estimate.wrench_in_base, robot_->dof()) && lately.valid &&
                              usable(lately.wrench_in_base, robot_->dof());
  if (can_be_located) {
    const PlatformVector& F = estimate.wrench_in_base;
    const PlatformMatrix noise = uncertainty_.covariance(robot_->space(), F);
    const PlatformMatrix errors = uncertainty_.errors(robot_->space(), F, lately.wrench_in_base);
    const BodyId body = ContactClasses::body(touched.most_likely);
    if (body.is_platform()) {
      found = locate_on_platform(*robot_, now, platform_, F, errors, settings_.least_force);
    } else if (F.head(robot_->space_dimension()).norm() >= settings_.least_force) {
      found = locate_on_link(link_contact_map(*robot_, now, body), body, F, noise, errors, settings_);
    }
  }
  found.acquired = estimate.acquired;
  return found;
}

}  // namespace flinch
