#include "experiments/campaign/drawn_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/scenario/scenario.h"
#include "plant/body_placement.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

constexpr double slowest = 0.02;  // [m/s]
constexpr double reach = 10.0;    // further from a body than any obstacle that touches it [m]

Eigen::Vector3d in_space(const CartesianVector& vector) {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  result.head(vector.size()) = vector;
  return result;
}

/// A direction of length 1 in the space in which the robot's points move.
Eigen::Vector3d random_direction(const Mechanism& robot, RandomGenerator& random) {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  do {
    for (int i = 0; i < robot.space_dimension(); ++i) direction[i] = random.uniform(-1.0, 1.0);
  } while (direction.norm() > 1.0 || direction.norm() < 0.1);
  return direction.normalized();
}

/// A body where it is now, for distances from it.
class PlacedBody {
 public:
  PlacedBody(const Mechanism& robot, const Kinematics& now, BodyId body)
      : at_(body_placement(robot, now, body)) {
    for (const Shape& part : robot.body(body).shapes) parts_.emplace_back(part);
  }

  /// From `obstacle` with its frame's origin at `place` [m]; negative where they penetrate.
  double gap(const Solid& obstacle, const Eigen::Vector3d& place) const {
    double smallest = reach;
    for (const Solid& part : parts_)
      smallest = std::min(smallest, nearest(part, at_, obstacle, {.origin = place}).gap);
    return smallest;
  }

 private:
  Placement at_;
  std::vector<Solid> parts_;
};

/// The obstacle's place on the ray from `start` along `normal` at which it just touches the body.
Eigen::Vector3d touching(const Mechanism& robot, const Kinematics& now, BodyId body, const Shape& shape,
                         const Eigen::Vector3d& start, const Eigen::Vector3d& normal) {
  const PlacedBody placed(robot, now, body);
  const Solid obstacle(shape);
  double inside = 0.0, outside = reach;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (placed.gap(obstacle, start + middle * normal) < 0.0 ? inside : outside) = middle;
  }
  return start + outside * normal;
}

/// Whether no body but those of `meant` is where the obstacle stands.
bool stands_free(const Mechanism& robot, const Kinematics& now, const Shape& shape,
                 const DrawnContact& contact, const std::vector<BodyId>& meant) {
  const Solid obstacle(shape);
  for (int i = 0; i < robot.body_count(); ++i) {
    const BodyId body = BodyId::from_index(i);
    if (std::find(meant.begin(), meant.end(), body) != meant.end()) continue;
    if (PlacedBody(robot, now, body).gap(obstacle, contact.position_in_base) < 0.0) return false;
  }
  return true;
}

/// The obstacle is moved away from a body, so it must be in that body at first.
void check_lies_about_position(const Shape& shape) {
  const Solid point(Sphere{.radius = 1e-6});
  if (nearest(Solid(shape), {}, point, {}).gap < 0.0) return;
  throw SetupError("'contact' cannot place the obstacle: its position is not within its points");
}

const PlatformPath& path_of(const Scenario& scenario) {
  const std::optional<PlatformPath>& path = scenario.control.trajectory.path;
  if (!path) throw SetupError("the scenario has no motion, so nothing runs into an obstacle");
  return *path;
}

Kinematics kinematics_at(const Scenario& scenario, double time) {
  const PlatformReference reference = path_of(scenario).evaluate(time);
  Kinematics now;
  scenario.robot.robot->kinematics(reference.pose, reference.velocity, now);
  return now;
}

/// The robot half-way through the motion of a scenario, and a millisecond later.
struct Instant {
  Kinematics now, later;
};

Instant half_way(const Scenario& scenario) {
  const double time = 0.5 * path_of(scenario).duration();
  return {kinematics_at(scenario, time), kinematics_at(scenario, time + 1e-3)};
}

/// Along a link, from its proximal to its distal joint.
Eigen::Vector3d along(const Mechanism& robot, const Kinematics& now, BodyId link) {
  return in_space(robot.point_on_body(now, link, robot.axis_point(link, 1.0)) -
                  robot.point_on_body(now, link, robot.axis_point(link, 0.0)))
      .normalized();
}

/// The obstacle against `in_body`, in the direction of `normal`.
std::optional<DrawnContact> contact_at(const Mechanism& robot, const Kinematics& now, BodyId body,
                                       const CartesianVector& in_body, const Eigen::Vector3d& normal,
                                       const Shape& shape) {
  const Eigen::Vector3d start = in_space(robot.point_on_body(now, body, in_body));
  const Eigen::Vector3d velocity =
      in_space(robot.contact_jacobian(now, body, in_body).translation * now.velocity);
  const DrawnContact contact{body_name(body), touching(robot, now, body, shape, start, normal), normal,
                             velocity};
  return stands_free(robot, now, shape, contact, {body}) ? std::optional(contact) : std::nullopt;
}

std::optional<DrawnContact> touch_body(const Mechanism& robot, const Kinematics& now, BodyId body,
                                       const Shape& shape, RandomGenerator& random) {
  const CartesianVector in_body = robot.axis_point(body, body.is_platform() ? 0.0 : random.uniform(0.1, 0.9));
  const ContactJacobian jacobian = robot.contact_jacobian(now, body, in_body);
  const Eigen::Vector3d velocity = in_space(jacobian.translation * now.velocity);
  Eigen::Vector3d normal;
  if (body.is_platform()) {
    if (velocity.norm() < slowest) return std::nullopt;
    normal = velocity.normalized() + 0.7 * random_direction(robot, random);
  } else {
    const Eigen::Vector3d axis = along(robot, now, body);
    normal = velocity - velocity.dot(axis) * axis;
    if (normal.norm() < slowest) return std::nullopt;
  }
  return contact_at(robot, now, body, in_body, normal.normalized(), shape);
}

/// The angle between the links of a leg at the elbow, and the direction half-way between them.
struct Elbow {
  explicit Elbow(const LegPoints& leg) {
    along = {in_space(leg.base_joint - leg.passive_joint).normalized(),
             in_space(leg.coupling_joint - leg.passive_joint).normalized()};
    angle = std::acos(std::clamp(along[0].dot(along[1]), -1.0, 1.0));
    bisector = (along[0] + along[1]).normalized();
    joint = in_space(leg.passive_joint);
  }
  double angle;
  std::array<Eigen::Vector3d, 2> along;  ///< each link, from the elbow
  Eigen::Vector3d bisector, joint;
};

std::optional<DrawnContact> clamp(const Mechanism& robot, const Instant& instant, int leg, const Shape& shape,
                                  double largest_gap, RandomGenerator& random) {
  const Elbow now(instant.now.legs[static_cast<std::size_t>(leg)]);
  const Elbow later(instant.later.legs[static_cast<std::size_t>(leg)]);
  if (later.angle >= now.angle || now.angle > 0.9 * EIGEN_PI) return std::nullopt;
  const BodyId link1 = BodyId::link1(leg), link2 = BodyId::link2(leg);
  const Eigen::Vector3d at1 = touching(robot, instant.now, link1, shape, now.joint, now.bisector);
  const Eigen::Vector3d at2 = touching(robot, instant.now, link2, shape, now.joint, now.bisector);
  const bool at1_is_further = (at1 - now.joint).norm() > (at2 - now.joint).norm();
  DrawnContact contact{"leg" + std::to_string(leg + 1) + "_clamping", at1_is_further ? at1 : at2, {}, {}};
  if (largest_gap > 0.0) {  // shifted along the link that is touched first
    const std::size_t first = random() % 2;
    contact.position_in_base += random.uniform(0.0, largest_gap) / std::sin(now.angle) * now.along[first];
    const PlacedBody link(robot, instant.now, first == 0 ? link1 : link2);
    if (link.gap(Solid(shape), contact.position_in_base) > 1e-6) return std::nullopt;
  }
  const bool is_free = stands_free(robot, instant.now, shape, contact, {link1, link2});
  return is_free ? std::optional(contact) : std::nullopt;
}

}  // namespace

std::optional<DrawnContact> draw_contact(const Scenario& scenario, const std::string& kind,
                                         const Shape& shape, RandomGenerator& random, double largest_gap) {
  check_lies_about_position(shape);
  const ParallelRobot& robot = *scenario.robot.robot;
  const Instant instant = half_way(scenario);
  if (!instant.now.reachable || !instant.later.reachable) return std::nullopt;
  if (kind == "platform") return touch_body(robot, instant.now, BodyId::platform(), shape, random);
  const int leg = static_cast<int>(random() % static_cast<std::uint64_t>(robot.legs()));
  if (kind == "clamping") {
    if (robot.space_dimension() > 2) {
      throw SetupError("contact.body: the links of this robot's legs slide; nothing is clamped between them");
    }
    return clamp(robot, instant, leg, shape, largest_gap, random);
  }
  return touch_body(robot, instant.now, kind == "link1" ? BodyId::link1(leg) : BodyId::link2(leg), shape,
                    random);
}

std::optional<DrawnContact> draw_touch(const ParallelRobot& robot, const Kinematics& now,
                                       const std::string& kind, const Shape& shape, RandomGenerator& random) {
  check_lies_about_position(shape);
  if (!now.reachable) return std::nullopt;
  Eigen::Vector3d normal = random_direction(robot, random);
  if (kind == "platform") {
    return contact_at(robot, now, BodyId::platform(), robot.axis_point(BodyId::platform(), 0.0), normal,
                      shape);
  }
  const int leg = static_cast<int>(random() % static_cast<std::uint64_t>(robot.legs()));
  const BodyId link = kind == "link1" ? BodyId::link1(leg) : BodyId::link2(leg);
  const Eigen::Vector3d axis = along(robot, now, link);
  normal -= normal.dot(axis) * axis;
  if (normal.norm() < 0.01) return std::nullopt;
  return contact_at(robot, now, link, robot.axis_point(link, random.uniform(0.1, 0.9)), normal.normalized(),
                    shape);
}

MeetingPoint meeting_point_of(const Scenario& scenario) {
  const double time = 0.5 * path_of(scenario).duration();
  return {kinematics_at(scenario, time), time};
}

}  // namespace flinch
