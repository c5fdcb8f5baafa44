#include "plant/contact_model.h"

#include <algorithm>
#include <cstddef>

namespace flinch {
namespace {

// Room for what accelerates within a tick: 1 mm in 1 ms takes 2000 m/s^2.
constexpr double reach_margin = 1e-3;  // [m]

double radius_of(BodyId body, const BenchShapes& shapes) {
  return body.is_platform() ? shapes.platform_radius : shapes.link_radius;
}

// Midway between the surfaces of a body and of the disc that it meets.
Eigen::Vector2d contact_point(const DiscGap& gap, double body_radius) {
  return gap.axis_point + (body_radius + 0.5 * gap.gap) * gap.normal;
}

// Force on a body whose surface approaches the disc's with `velocity`.
Eigen::Vector2d contact_force(const HuntCrossley& law, const DiscGap& gap, const Eigen::Vector2d& velocity) {
  const Eigen::Vector2d tangent = normal(gap.normal);
  const double push = law.normal_force(-gap.gap, velocity.dot(gap.normal));
  return -push * gap.normal + law.friction_force(push, velocity.dot(tangent)) * tangent;
}

// No point of the robot is faster: links are as fast as their joints, and the platform's rim bounds these.
double greatest_speed(const PlanarMotion& motion, double platform_radius) {
  double speed = motion.velocity.head<2>().norm() + platform_radius * std::abs(motion.velocity.z());
  for (const PlanarLegMotion& leg : motion.legs) {
    speed = std::max(speed, std::abs(leg.qa_rate) * (leg.leg.passive_joint - leg.leg.base_joint).norm());
  }
  return speed;
}

PlanarMotion home_motion(const PlanarRrr& robot) {
  return robot.motion(robot.parameters().home_pose, Eigen::Vector3d::Zero());
}

BenchShapes shapes_of(const PlanarRrr& robot, const std::optional<Pylon>& pylon) {
  const auto& parameters = robot.parameters();
  return {parameters.link_radius, parameters.platform_hull_radius, pylon ? pylon->radius : 0.0};
}

std::optional<HuntCrossley> law_of(const std::optional<ContactMaterial>& material) {
  return material ? std::optional(HuntCrossley(*material)) : std::nullopt;
}

}  // namespace

ContactModel::ContactModel(const PlanarRrr& robot, const std::optional<Pylon>& pylon,
                           const std::optional<ContactMaterial>& link_material)
    : shapes_(shapes_of(robot, pylon)),
      broad_phase_(shapes_, home_motion(robot)),
      pylon_law_(law_of(pylon ? std::optional(pylon->material) : std::nullopt)),
      link_law_(law_of(link_material)) {}

ContactCandidates ContactModel::candidates(const PlanarMotion& motion, const PylonMotion& pylon,
                                           double duration) const noexcept {
  const double speed = 2.0 * greatest_speed(motion, shapes_.platform_radius) + pylon.velocity.norm();
  const double reach = duration * speed + reach_margin;
  const BroadPhase::Boxes boxes = broad_phase_.boxes(motion, pylon);
  ContactCandidates candidates;
  const std::size_t first = pylon_law_ ? 0 : pylon_pair_count;
  const std::size_t end = link_law_ ? contact_pair_count : pylon_pair_count;
  for (std::size_t i = first; i < end; ++i) {
    if (can_touch(contact_pairs[i], motion, pylon, reach, boxes)) candidates.add(i);
  }
  return candidates;
}

bool ContactModel::can_touch(const ContactPair& pair, const PlanarMotion& motion, const PylonMotion& pylon,
                             double reach, const BroadPhase::Boxes& boxes) const noexcept {
  const bool of_pylon = pair.round == ContactPair::Round::pylon;
  const auto index = [](BodyId body) { return static_cast<std::size_t>(body.index()); };
  const BroadPhase::Box& round = boxes[of_pylon ? BroadPhase::pylon : index(round_body(pair))];
  const auto near = [&](BodyId body) { return round.overlaps(boxes[index(body)], reach); };
  const bool boxes_overlap = pair.against == ContactPair::Against::platform
                                 ? near(BodyId::platform())
                                 : near(BodyId::link1(pair.leg)) || near(BodyId::link2(pair.leg));
  if (!boxes_overlap) return false;

  bool within_reach = false;
  for_each_gap(shapes_, pair, motion, shapes_.round(pair, motion, pylon),
               [&](BodyId, const DiscGap& gap) { within_reach = within_reach || gap.gap <= reach; });
  return within_reach;
}

void ContactModel::forces(const PlanarMotion& motion, const PylonMotion& pylon, ContactCandidates candidates,
                          ContactForces& out) const noexcept {
  out.pylon_wrench.setZero();
  out.self_wrench.setZero();
  out.force_on_pylon.setZero();
  out.touch_count = 0;
  out.self_contact = false;
  candidates.for_each([&](const ContactPair& pair) {
    const bool of_pylon = pair.round == ContactPair::Round::pylon;
    if (of_pylon ? !pylon_law_ : !link_law_) return;
    for_each_gap(shapes_, pair, motion, shapes_.round(pair, motion, pylon),
                 [&](BodyId body, const DiscGap& gap) {
                   if (gap.gap >= 0.0) return;
                   if (of_pylon) {
                     add_touch(motion, pylon, body, gap, out);
                   } else {
                     add_self_contact(motion, round_body(pair), body, gap, out);
                   }
                 });
  });
}

void ContactModel::add_touch(const PlanarMotion& motion, const PylonMotion& pylon, BodyId body,
                             const DiscGap& gap, ContactForces& out) const noexcept {
  Touch& touch = out.touches[static_cast<std::size_t>(out.touch_count++)];
  touch.body = body;
  touch.depth = -gap.gap;
  touch.point = contact_point(gap, radius_of(body, shapes_));
  const Eigen::Vector2d velocity = point_velocity(motion, body, touch.point) - pylon.velocity;
  touch.force_on_robot = contact_force(*pylon_law_, gap, velocity);
  out.pylon_wrench += contact_wrench(motion, body, touch.point, touch.force_on_robot);
  out.force_on_pylon -= touch.force_on_robot;
}

void ContactModel::add_self_contact(const PlanarMotion& motion, BodyId round, BodyId body, const DiscGap& gap,
                                    ContactForces& out) const noexcept {
  const Eigen::Vector2d point = contact_point(gap, radius_of(body, shapes_));
  const Eigen::Vector2d velocity = point_velocity(motion, body, point) - point_velocity(motion, round, point);
  const Eigen::Vector2d force = contact_force(*link_law_, gap, velocity);
  out.self_wrench +=
      contact_wrench(motion, body, point, force) + contact_wrench(motion, round, point, -force);
  out.self_contact = true;
}

void ContactModel::pylon_gaps(const PlanarMotion& motion, const PylonMotion& pylon,
                              PylonGaps& out) const noexcept {
  out = PylonGaps();
  if (!pylon_law_) return;
  const Disc disc{pylon.position, shapes_.pylon_radius};
  for (std::size_t i = 0; i < bench_body_count; ++i) {
    const BodyId body = BodyId::from_index(static_cast<int>(i));
    const DiscGap nearest = gap_to_disc(shapes_.body(motion, body), disc);
    out.gap[i] = nearest.gap;
    out.rate[i] = nearest.normal.dot(pylon.velocity - point_velocity(motion, body, nearest.axis_point));
  }
}

}  // namespace flinch
