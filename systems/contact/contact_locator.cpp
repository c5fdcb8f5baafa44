#include "systems/contact/contact_locator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/alike_links.h"
#include "systems/robot/contact_jacobian.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/line_of_action.h"
#include "systems/robot/rotation.h"

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

/// Covariance of how far the errors of a wrench move its line of action across itself [m^2], base frame.
/// `arm`: from the platform's origin to a point on the line.
Eigen::Matrix3d shift_covariance(const ConfigurationSpace& space, const PlatformMatrix& covariance,
                                 const Eigen::Vector3d& arm, const Eigen::Vector3d& force) {
  constexpr double anywhere = 1e3;  // [m]
  const int directions = space.translations(), rotations = space.rotations();
  const Eigen::Vector3d along = force.normalized();
  if (rotations == 0) {  // such a wrench does not tell where its line lies
    Eigen::Matrix3d across = -along * along.transpose();
    across.diagonal().head(directions).array() += 1.0;
    return anywhere * anywhere * across;
  }
  const Eigen::Matrix3d of_moment = cross_matrix(along) / force.norm();  // about the point on the line
  CartesianJacobian of_wrench(3, space.dimension());
  of_wrench.leftCols(directions) = -(of_moment * cross_matrix(arm)).leftCols(directions);
  of_wrench.rightCols(rotations) = of_moment.rightCols(rotations);
  return of_wrench * covariance * of_wrench.transpose();
}

/// Lines parallel to one, evenly spaced along an axis across it from one edge of an outline to the other, or
/// as far as errors may have moved the nearest of them.
struct ParallelLines {
  static constexpr int most = 9;
  int count = 1;
  std::array<double, most> shift{0.0};
  std::array<double, most> likelihood{1.0};  // over that of the nearest

  ParallelLines() = default;
  ParallelLines(const Outline& outline, const Eigen::Vector3d& on_line, const Eigen::Vector3d& axis,
                double deviation)
      : count(most) {
    constexpr double reach = 4.0;
    const double first = axis.dot(outline.farthest(-axis) - on_line);
    const double last = axis.dot(outline.farthest(axis) - on_line);
    const double nearest = std::max(first, std::min(0.0, last));
    const double low = std::max(first, nearest - reach * deviation);
    const double high = std::min(last, nearest + reach * deviation);
    for (std::size_t i = 0; i < most; ++i) {
      shift[i] = low + (static_cast<double>(i) + 0.5) / most * (high - low);
      likelihood[i] = std::exp(-0.5 * (shift[i] * shift[i] - nearest * nearest) / (deviation * deviation));
    }
  }
};

/// Root mean square distance from `point` of where lines enter the outline, over all that hit it, each as
/// likely as errors of `covariance` move the measured one there; where none of them hits it, how far they
/// move the line. (Derived.)
double entry_deviation(const Outline& outline, const Eigen::Vector3d& on_line,
                       const Eigen::Vector3d& direction, const Eigen::Matrix3d& covariance,
                       const Eigen::Vector3d& point, int directions) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(covariance);  // the smallest: along the line
  constexpr double least = 1e-9;  // of a deviation; rounding may leave less than nothing [m]
  const auto along_axis = [&](int axis) {
    return ParallelLines(outline, on_line, principal.eigenvectors().col(axis),
                         std::sqrt(std::max(principal.eigenvalues()[axis], least * least)));
  };
  const ParallelLines widest = along_axis(2);
  const ParallelLines other = directions == 3 ? along_axis(1) : ParallelLines();
  double likelihood = 0.0, squares = 0.0;
  for (int i = 0; i < widest.count; ++i) {
    for (int j = 0; j < other.count; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const Eigen::Vector3d moved = on_line + widest.shift[a] * principal.eigenvectors().col(2) +
                                    other.shift[b] * principal.eigenvectors().col(1);
      const LinePassage passage = outline.passage(moved, direction);
      if (!passage.hits) continue;
      const double share = widest.likelihood[a] * other.likelihood[b];
      likelihood += share;
      squares += share * (moved + passage.enter * direction - point).squaredNorm();
    }
  }
  return std::sqrt(likelihood > 0.0 ? squares / likelihood : covariance.trace());
}

}  // namespace

double unexplained(const PlatformVector& missed, const PlatformMatrix& covariance) noexcept {
  return missed.dot(covariance.llt().solve(missed));
}

ContactLocation locate_on_platform(const ParallelRobot& robot, const Kinematics& kinematics,
                                   const Outline& platform, const PlatformVector& wrench,
                                   const PlatformMatrix& noise, const PlatformMatrix& errors,
                                   double least_force) noexcept {
  ContactLocation location;
  const LineOfAction line = line_of_action(robot.space(), wrench, least_force);
  if (!line.valid || !kinematics.valid) return location;
  const int directions = robot.space_dimension();
  location.valid = true;
  location.body = BodyId::platform().index();
  location.force_in_base = wrench.head(directions);
  location.force_deviation =
      std::sqrt(line.direction.dot(errors.topLeftCorner(directions, directions) * line.direction));
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
  const Eigen::Matrix3d shift =
      shift_covariance(robot.space(), errors, arm, in_space(location.force_in_base));
  location.point_deviation =
      entry_deviation(platform, lever, direction, axes.transpose() * shift * axes, point, directions);
  const ContactJacobian J = robot.contact_jacobian(kinematics, BodyId::platform(), point.head(directions));
  location.residual = unexplained(wrench - platform_wrench(J, location.force_in_base), noise);
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

ContactLocation locate_on_link(const LinkContactMap& map, BodyId link, const PlatformVector& velocity,
                               const PlatformVector& wrench, const PlatformMatrix& noise,
                               const PlatformMatrix& errors,
                               const ContactLocatorSettings& settings) noexcept {
  ContactLocation location;
  const LinkPush across = link_push(map, wrench, noise, settings.largest_deviation);
  if (!across.valid) return location;
  const Lean lean = lean_by_friction(map, velocity, across.fraction, Eigen::Vector2d(0.0, across.force),
                                     settings.leaning, settings.object_speed);
  const LinkPush push = link_push(map, wrench, noise, settings.largest_deviation, lean.mean);
  const CartesianVector force = push.force * Eigen::Vector2d(push.force < 0.0 ? -lean.mean : lean.mean, 1.0);
  location.valid = true;
  location.body = link.index();
  location.fraction = std::clamp(push.fraction, 0.0, 1.0);
  location.force_in_base = map.axes * force;
  location.point_in_base = pushed_point(map, location.fraction, location.force_in_base);
  location.covariance = push.covariance;
  if (push.identifiable)
    location.covariance =
        push_covariance(map, push.fraction, force, errors) + lean_covariance(map, wrench, noise, push, lean);
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
      alike_(legs_of_alike_links(*robot_)),
      platform_(robot_->body(BodyId::platform()).shapes),
      settings_(settings),
      uncertainty_(uncertainty) {
  Findings found("contact locator: ");
  found.positive("least_force", settings.least_force, "N");
  found.positive("largest_deviation", settings.largest_deviation);
  found.not_negative("leaning", settings.leaning);
  found.positive("object_speed", settings.object_speed, "m/s");
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
    const PlatformMatrix noise = uncertainty_.covariance(robot_->space(), now, F);
    const PlatformMatrix errors = uncertainty_.errors(robot_->space(), now, F, lately.wrench_in_base);
    const BodyId body = ContactClasses::body(touched.most_likely);
    if (body.is_platform()) {
      found = locate_on_platform(*robot_, now, platform_, F, noise, errors, settings_.least_force);
    } else if (!alike_[static_cast<std::size_t>(body.leg())] &&
               F.head(robot_->space_dimension()).norm() >= settings_.least_force) {
      found = locate_on_link(link_contact_map(*robot_, now, body), body, now.velocity, F, noise, errors,
                             settings_);
    }
  }
  found.acquired = estimate.acquired;
  return found;
}

}  // namespace flinch
