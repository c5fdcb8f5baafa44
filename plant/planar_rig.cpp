#include "plant/planar_rig.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flinch {
namespace {

// Room for what accelerates within a tick: 1 mm in 1 ms takes 2000 m/s^2.
constexpr double reach_margin = 1e-3;  // [m]
// So far beyond the reach of a tick is looked, so that several ticks do without a search.
constexpr double outlook = 0.03;  // [m]

Eigen::Vector3d in_space(const Eigen::Vector2d& v) { return {v.x(), v.y(), 0.0}; }

// No point of the robot is faster: links are as fast as their joints, and the platform's rim bounds these.
double greatest_speed(const PlanarMotion& motion, double platform_radius) {
  double speed = motion.velocity.head<2>().norm() + platform_radius * std::abs(motion.velocity.z());
  for (const PlanarLegMotion& leg : motion.legs) {
    speed = std::max(speed, std::abs(leg.qa_rate) * (leg.leg.passive_joint - leg.leg.base_joint).norm());
  }
  return speed;
}

/// A box whose sides are parallel to the axes of the base frame [m].
struct PlanarBox {
  Eigen::Vector2d low;
  Eigen::Vector2d high;

  explicit PlanarBox(const PlanarCapsule& capsule)
      : low(capsule.begin.cwiseMin(capsule.end).array() - capsule.radius),
        high(capsule.begin.cwiseMax(capsule.end).array() + capsule.radius) {}

  /// Whether a disc comes within `reach` of the box.
  bool is_near(const Disc& disc, double reach) const {
    const double room = disc.radius + reach;
    return disc.centre.x() - high.x() <= room && low.x() - disc.centre.x() <= room &&
           disc.centre.y() - high.y() <= room && low.y() - disc.centre.y() <= room;
  }
};

/// Origin and x axis of a body's frame.
struct PlanarFrame {
  Eigen::Vector2d origin;
  Eigen::Vector2d axis;
};

PlanarFrame frame(const PlanarMotion& motion, BodyId body) {
  if (body.is_platform()) {
    return {motion.pose.head<2>(), {std::cos(motion.pose.z()), std::sin(motion.pose.z())}};
  }
  const PlanarLeg& leg = motion.legs[static_cast<std::size_t>(body.leg())].leg;
  if (body.is_link1()) return {leg.base_joint, leg.u1};
  return {leg.passive_joint, leg.u2};
}

std::vector<Sphere> rounds_of(const Obstacles& obstacles) {
  std::vector<Sphere> rounds;
  for (const auto& obstacle : obstacles) rounds.push_back(std::get<Sphere>(obstacle->form().shape));
  return rounds;
}

std::array<Eigen::Vector2d, 3> base_directions(const PlanarRrr& robot) {
  const auto& legs = robot.parameters().legs;
  return {unit_vector(legs[0].base_angle), unit_vector(legs[1].base_angle), unit_vector(legs[2].base_angle)};
}

}  // namespace

PlanarRig::PlanarRig(const RigSettings& settings)
    : robot_(std::dynamic_pointer_cast<const PlanarRrr>(settings.robot)),
      base_directions_(base_directions(*robot_)),
      shapes_{robot_->parameters().link_radius, robot_->parameters().platform_hull_radius},
      rounds_(rounds_of(settings.obstacles)),
      links_meet_(settings.link_material.has_value()),
      torque_ripple_(settings.torque_ripple) {
  const bool all_repeat =
      std::all_of(torque_ripple_.begin(), torque_ripple_.end(), [](const TorqueRipple& torque) {
        return std::all_of(torque.cogging.begin(), torque.cogging.end(), repeats_each_turn) &&
               repeats_each_turn(torque.ripple);
      });
  if (!all_repeat) return;
  for (const TorqueRipple& torque : torque_ripple_)
    turning_torque_.push_back(
        {{torque.cogging.begin(), torque.cogging.end()}, TurningHarmonic(torque.ripple)});
}

Disc PlanarRig::disc(int obstacle, const PlacedObstacle& placed) const noexcept {
  const Sphere& round = rounds_[static_cast<std::size_t>(obstacle)];
  return {placed.position.head<2>() + round.centre.head<2>(), round.radius};
}

SurfaceGap PlanarRig::surface_gap(const DiscGap& gap, BodyId body) const noexcept {
  return {gap.gap, in_space(gap.normal),
          in_space(gap.axis_point + (shapes_.radius(body) + 0.5 * gap.gap) * gap.normal)};
}

Eigen::Vector2d PlanarRig::drive_direction(const Instant& now, int drive) const noexcept {
  const auto index = static_cast<std::size_t>(drive);
  const Eigen::Vector2d& link = now.legs[index].leg.u1;
  return {base_directions_[index].dot(link), cross(base_directions_[index], link)};
}

double PlanarRig::drive_position(const Instant& now, int drive) const noexcept {
  const Eigen::Vector2d direction = drive_direction(now, drive);
  return std::atan2(direction.y(), direction.x());
}

double PlanarRig::torque_ripple(const Instant& now, int drive, double torque) const noexcept {
  const auto index = static_cast<std::size_t>(drive);
  if (turning_torque_.empty()) return torque_ripple_[index].at(drive_position(now, drive), torque);
  return turning_torque_[index].at(drive_direction(now, drive), torque);
}

void PlanarRig::describe(const Instant& now, RigSnapshot& out) const noexcept {
  out.joints = robot_->joint_angles(now);
  out.loop_closure_error = robot_->chain_closure_error(now);
  out.kinetic_energy = robot_->kinetic_energy(now);
}

Eigen::Vector3d PlanarRig::point_velocity(const Instant& now, int body,
                                          const Eigen::Vector3d& point) const noexcept {
  return in_space(flinch::point_velocity(now, BodyId::from_index(body), point.head<2>()));
}

Eigen::Vector3d PlanarRig::point_in_body(const Instant& now, int body,
                                         const Eigen::Vector3d& point) const noexcept {
  const PlanarFrame at = frame(now, BodyId::from_index(body));
  const Eigen::Vector2d arm = point.head<2>() - at.origin;
  return {arm.dot(at.axis), cross(at.axis, arm), 0.0};
}

Eigen::Vector3d PlanarRig::point_in_base(const Instant& now, int body,
                                         const Eigen::Vector3d& point) const noexcept {
  const PlanarFrame at = frame(now, BodyId::from_index(body));
  return in_space(at.origin + rotate(at.axis, point.head<2>()));
}

SurfaceGap PlanarRig::gap(const Instant& now, int body, int obstacle,
                          const PlacedObstacles& obstacles) const noexcept {
  const BodyId of = BodyId::from_index(body);
  const Disc round = disc(obstacle, obstacles[static_cast<std::size_t>(obstacle)]);
  return surface_gap(gap_to_disc(shapes_.body(now, of), round), of);
}

void PlanarRig::find_near_pairs(const Instant& now, const PlacedObstacles& obstacles,
                                NearPairs& out) const noexcept {
  for (int obstacle = 0; obstacle < static_cast<int>(rounds_.size()); ++obstacle) {
    const PlacedObstacle& placed = obstacles[static_cast<std::size_t>(obstacle)];
    const Disc round = disc(obstacle, placed);
    for (int index = 0; index < planar_body_count; ++index) {
      const BodyId body = BodyId::from_index(index);
      const DiscGap nearest = gap_to_disc(shapes_.body(now, body), round);
      const Eigen::Vector2d velocity = flinch::point_velocity(now, body, nearest.axis_point);
      const double rate = nearest.normal.dot(placed.velocity.head<2>() - velocity);
      out.add({index, obstacle, nearest.gap, rate});
    }
  }
}

/// Of the bodies that `disc` may touch, also where another contact stands for theirs.
double PlanarRig::least_gap(const Instant& now, const PlanarPair& pair, const Disc& disc) const noexcept {
  using Against = PlanarPair::Against;
  const auto gap_to = [&](BodyId body) { return gap_to_disc(shapes_.body(now, body), disc).gap; };
  if (pair.against == Against::platform) return gap_to(BodyId::platform());
  if (pair.against == Against::link1) return gap_to(BodyId::link1(pair.leg));
  if (pair.against == Against::link2) return gap_to(BodyId::link2(pair.leg));
  return std::min(gap_to(BodyId::link1(pair.leg)), gap_to(BodyId::link2(pair.leg)));
}

ContactSearch PlanarRig::find_candidates(const Instant& now, const PlacedObstacles& obstacles,
                                         double duration, double clearance) const noexcept {
  const double speed = 2.0 * greatest_speed(now, shapes_.platform_radius);
  const auto reach_beside = [&](double other_speed) {
    return duration * (speed + other_speed) + reach_margin;
  };
  double fastest = 0.0;
  for (std::size_t i = 0; i < rounds_.size(); ++i) fastest = std::max(fastest, obstacles[i].velocity.norm());
  const double longest_reach = reach_beside(fastest);
  if (clearance > longest_reach) return {{}, clearance - longest_reach};

  const auto box = [&](BodyId body) { return PlanarBox(shapes_.body(now, body)); };
  const std::array<PlanarBox, planar_body_count> boxes = {
      box(BodyId::platform()), box(BodyId::link1(0)), box(BodyId::link2(0)), box(BodyId::link1(1)),
      box(BodyId::link2(1)),   box(BodyId::link1(2)), box(BodyId::link2(2))};
  const auto box_is_near = [&](BodyId body, const Disc& disc, double reach) {
    return boxes[static_cast<std::size_t>(body.index())].is_near(disc, reach);
  };

  ContactSearch search{{}, outlook};
  for (std::size_t number = links_meet_ ? 0 : planar_self_pairs; number < pair_count(); ++number) {
    const PlanarPair pair = planar_pair(number);
    const bool of_obstacle = pair.round == PlanarPair::Round::obstacle;
    const auto which = static_cast<std::size_t>(pair.which);
    const Disc round = of_obstacle ? disc(pair.which, obstacles[which]) : shapes_.joint(pair, now);
    const double reach = reach_beside(of_obstacle ? obstacles[which].velocity.norm() : 0.0);
    const double far = reach + outlook;
    const bool boxes_are_near = pair.against == PlanarPair::Against::platform
                                    ? box_is_near(BodyId::platform(), round, far)
                                    : box_is_near(BodyId::link1(pair.leg), round, far) ||
                                          box_is_near(BodyId::link2(pair.leg), round, far);
    if (!boxes_are_near || least_gap(now, pair, round) > far) continue;
    search.clearance = 0.0;
    flinch::for_each_gap(shapes_, pair, now, round, [&](BodyId, const DiscGap& gap) {
      if (gap.gap <= reach) search.candidates.add(number);
    });
  }
  return search;
}

}  // namespace flinch
