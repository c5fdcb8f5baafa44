#include "plant/general_rig.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "plant/body_placement.h"
#include "systems/robot/forward_dynamics.h"
#include "systems/robot/parallel_robot.h"
#include "systems/robot/rotation.h"

namespace flinch {
namespace {

// Room for what accelerates within a tick: 1 mm in 1 ms takes 2000 m/s^2.
constexpr double reach_margin = 1e-3;  // [m]

std::size_t index(int i) { return static_cast<std::size_t>(i); }

bool turns_in_space(const ConfigurationSpace& space) { return space.rotations() == 3; }

// Boxes that are near tell nothing of a pair; those that are not need no exact distance.
AxisBox around(const std::vector<Solid>& shapes, const Placement& at) {
  AxisBox whole = shapes.front().box(at);
  for (const Solid& shape : shapes) {
    const AxisBox box = shape.box(at);
    whole = {whole.low.cwiseMin(box.low), whole.high.cwiseMax(box.high)};
  }
  return whole;
}

Placement placement(const PlacedObstacle& obstacle) { return {.origin = obstacle.position}; }

}  // namespace

GeneralRig::GeneralRig(const RigSettings& settings)
    : robot_(settings.robot), directions_(robot_->space_dimension()), torque_ripple_(settings.torque_ripple) {
  for (const Body& body : robot_->description().bodies) {
    std::vector<Solid>& shapes = bodies_.emplace_back();
    for (const Shape& shape : body.shapes) shapes.emplace_back(shape);
  }
  for (const auto& obstacle : settings.obstacles) obstacles_.emplace_back(obstacle->form().shape);
  if (!settings.link_material) return;
  for (const BodyPair& pair : robot_->description().self_collision_pairs) {
    if (!bodies_[index(pair.a)].empty() && !bodies_[index(pair.b)].empty()) self_pairs_.push_back(pair);
  }
  beside_platform_.resize(bodies_.size());
  for (const BesidePlatform& link : robot_->description().beside_platform) {
    beside_platform_[index(link.body)].emplace_back(link.shape);
    self_pairs_.push_back({BodyId::platform().index(), link.body});
  }
}

// ---------------------------------------------------------------- motion

Configuration GeneralRig::pose(const RigState& state, const RigChart& chart) const noexcept {
  const int n = robot_->dof();
  if (!turns_in_space(robot_->space())) return state.head(n);
  return robot_->space().plus(chart.pose, state.head(n) - chart.xi);
}

bool GeneralRig::at(const RigState& state, const RigChart& chart, Instant& now) const noexcept {
  const int n = robot_->dof();
  robot_->equations_of_motion(pose(state, chart), state.segment(n, n), now.kinematics, now.equations);
  return now.equations.valid;
}

void GeneralRig::coordinate_rates(const RigState& state, const RigChart& chart,
                                  RigState& rates) const noexcept {
  const int n = robot_->dof();
  rates.head(n) = state.segment(n, n);
  if (!turns_in_space(robot_->space())) return;
  const Eigen::Vector3d turned = state.segment<3>(3) - chart.xi.tail<3>();
  rates.segment<3>(3) = inverse_left_jacobian(turned) * state.segment<3>(n + 3);
}

PlatformVector GeneralRig::acceleration(const Instant& now, const JointVector& torque,
                                        const PlatformVector& wrench) const noexcept {
  return forward_dynamics(now.kinematics, now.equations, torque, wrench)
      .value_or(PlatformVector::Zero(robot_->dof()));
}

void GeneralRig::describe(const Instant& now, RigSnapshot& out) const noexcept {
  out.joints = now.kinematics.joints;
  out.kinetic_energy = kinetic_energy(now.kinematics, now.equations);
  const auto* parallel = dynamic_cast<const ParallelRobot*>(robot_.get());
  const bool has_chains = parallel != nullptr && out.joints.passive.size() > 0;
  out.loop_closure_error =
      has_chains ? parallel->chain_closure_error(out.joints.active, out.joints.passive, now.kinematics.pose)
                 : 0.0;
}

// ---------------------------------------------------------------- points of bodies

Eigen::Vector3d GeneralRig::in_space(const CartesianVector& v) const noexcept {
  Eigen::Vector3d full = Eigen::Vector3d::Zero();
  full.head(directions_) = v;
  return full;
}

Placement GeneralRig::placement(const Instant& now, int body) const noexcept {
  return body_placement(*robot_, now.kinematics, BodyId::from_index(body));
}

Eigen::Vector3d GeneralRig::point_in_body(const Instant& now, int body,
                                          const Eigen::Vector3d& point) const noexcept {
  const Placement at = placement(now, body);
  return at.axes.transpose() * (point - at.origin);
}

Eigen::Vector3d GeneralRig::point_in_base(const Instant& now, int body,
                                          const Eigen::Vector3d& point) const noexcept {
  return in_space(robot_->point_on_body(now.kinematics, BodyId::from_index(body), cartesian(point)));
}

Eigen::Vector3d GeneralRig::point_velocity(const Instant& now, int body,
                                           const Eigen::Vector3d& point) const noexcept {
  const ContactJacobian at = robot_->contact_jacobian(now.kinematics, BodyId::from_index(body),
                                                      cartesian(point_in_body(now, body, point)));
  return in_space(at.translation * now.kinematics.velocity);
}

PlatformVector GeneralRig::wrench(const Instant& now, int body, const Eigen::Vector3d& point,
                                  const Eigen::Vector3d& force) const noexcept {
  const ContactJacobian at = robot_->contact_jacobian(now.kinematics, BodyId::from_index(body),
                                                      cartesian(point_in_body(now, body, point)));
  return platform_wrench(at, cartesian(force));
}

void GeneralRig::place_bodies(const Instant& now, Placements& out) const noexcept {
  for (int body = 0; body < robot_->body_count(); ++body) out[index(body)] = placement(now, body);
}

// ---------------------------------------------------------------- what may touch

std::size_t GeneralRig::pair_count() const noexcept {
  const std::size_t pairs = self_pairs_.size() + bodies_.size() * obstacles_.size();
  return std::min(pairs, ContactCandidates::capacity);
}

GeneralRig::Pair GeneralRig::pair(std::size_t number) const noexcept {
  const std::size_t of_obstacles = bodies_.size() * obstacles_.size();
  if (number < of_obstacles) {
    return {static_cast<int>(number % bodies_.size()), static_cast<int>(number / bodies_.size()), true};
  }
  const BodyPair& both = self_pairs_[number - of_obstacles];
  return {both.a, both.b, false};
}

// A planar robot meets only what lies in its plane: the normal is the share of it that does.
SurfaceGap GeneralRig::in_space_of_robot(SurfaceGap gap) const noexcept {
  if (directions_ == 3) return gap;
  gap.normal.z() = 0.0;
  const double length = gap.normal.norm();
  if (length < 0.1) return {std::numeric_limits<double>::infinity(), Eigen::Vector3d::UnitX(), gap.point};
  gap.normal /= length;
  gap.point.z() = 0.0;
  return gap;
}

SurfaceGap GeneralRig::gap(const Pair& pair, const Placements& bodies,
                           const PlacedObstacles& obstacles) const noexcept {
  SurfaceGap least{std::numeric_limits<double>::infinity(), Eigen::Vector3d::UnitX(),
                   Eigen::Vector3d::Zero()};
  const auto take = [&](const SurfaceGap& found) {
    if (found.gap < least.gap) least = found;
  };
  for (const Solid& shape : bodies_[index(pair.body)]) {
    const Placement& at = bodies[index(pair.body)];
    if (pair.of_obstacle) {
      take(
          nearest(shape, at, obstacles_[index(pair.other)], flinch::placement(obstacles[index(pair.other)])));
      continue;
    }
    const bool of_platform = pair.body == BodyId::platform().index();
    for (const Solid& other : (of_platform ? beside_platform_ : bodies_)[index(pair.other)]) {
      take(nearest(shape, at, other, bodies[index(pair.other)]));
    }
  }
  return in_space_of_robot(least);
}

SurfaceGap GeneralRig::gap(const Instant& now, int body, int obstacle,
                           const PlacedObstacles& obstacles) const noexcept {
  Placements bodies;
  bodies[index(body)] = placement(now, body);
  return gap(Pair{body, obstacle, true}, bodies, obstacles);
}

// Of the corners of the bodies' boxes, which hold all their points.
double GeneralRig::greatest_speed(const Instant& now, const Placements& bodies,
                                  const Boxes& boxes) const noexcept {
  double greatest = 0.0;
  for (int body = 0; body < robot_->body_count(); ++body) {
    const ContactJacobian origin = robot_->contact_jacobian(now.kinematics, BodyId::from_index(body),
                                                            CartesianVector::Zero(directions_));
    const PlatformVector& v = now.kinematics.velocity;
    const AxisBox& box = boxes[index(body)];
    const Eigen::Vector3d& from = bodies[index(body)].origin;
    const double farthest = (box.high - from).cwiseAbs().cwiseMax((box.low - from).cwiseAbs()).norm();
    greatest = std::max(greatest, (origin.translation * v).norm() + farthest * (origin.rotation * v).norm());
  }
  return greatest;
}

ContactSearch GeneralRig::find_candidates(const Instant& now, const PlacedObstacles& obstacles,
                                          double duration, double) const noexcept {
  ContactSearch search;
  if (pair_count() == 0) return search;
  Placements bodies;
  place_bodies(now, bodies);
  Boxes boxes;
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    if (!bodies_[body].empty()) boxes[body] = around(bodies_[body], bodies[body]);
  }
  const double speed = 2.0 * greatest_speed(now, bodies, boxes);
  for (std::size_t number = 0; number < pair_count(); ++number) {
    const Pair both = pair(number);
    if (bodies_[index(both.body)].empty()) continue;
    const double other_speed = both.of_obstacle ? obstacles[index(both.other)].velocity.norm() : 0.0;
    const double reach = duration * (speed + other_speed) + reach_margin;
    const AxisBox other =
        both.of_obstacle ? obstacles_[index(both.other)].box(flinch::placement(obstacles[index(both.other)]))
                         : boxes[index(both.other)];
    if (!boxes[index(both.body)].is_near(other, reach)) continue;
    if (gap(both, bodies, obstacles).gap <= reach) search.candidates.add(number);
  }
  return search;
}

void GeneralRig::find_near_pairs(const Instant& now, const PlacedObstacles& obstacles,
                                 NearPairs& out) const noexcept {
  if (obstacles_.empty()) return;
  Placements bodies;
  place_bodies(now, bodies);
  const std::size_t pairs = std::min(bodies_.size() * obstacles_.size(), ContactCandidates::capacity);
  for (std::size_t number = 0; number < pairs; ++number) {
    const Pair both = pair(number);
    if (bodies_[index(both.body)].empty()) continue;
    const PlacedObstacle& obstacle = obstacles[index(both.other)];
    const AxisBox box = around(bodies_[index(both.body)], bodies[index(both.body)]);
    const AxisBox other = obstacles_[index(both.other)].box(flinch::placement(obstacle));
    if (!box.is_near(other, NearPairs::near_distance)) continue;
    const SurfaceGap nearest = gap(both, bodies, obstacles);
    const Eigen::Vector3d velocity = point_velocity(now, both.body, nearest.point);
    out.add({both.body, both.other, nearest.gap, nearest.normal.dot(obstacle.velocity - velocity)});
  }
}

}  // namespace flinch
