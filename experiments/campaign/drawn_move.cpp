#include "experiments/campaign/drawn_move.h"

#include <cmath>

#include "experiments/campaign/campaign.h"
#include "systems/framework/random.h"

namespace flinch {
namespace {

constexpr double slowest_approach = 0.05;  // [m/s]
constexpr double meeting_duration = 0.4;   // of the obstacle's motion [s]
/// Speed half-way of a motion from rest to rest, over its mean speed: see ObstaclePath.
constexpr double peak_speed = 1.875;
constexpr double clearance = 0.005;  // between body and obstacle before a push [m]

Eigen::Vector3d random_direction(int directions, RandomGenerator& random) {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  do {
    for (int i = 0; i < directions; ++i) direction[i] = random.uniform(-1.0, 1.0);
  } while (direction.norm() > 1.0 || direction.norm() < 0.1);
  return direction.normalized();
}

}  // namespace

std::optional<DrawnMove> draw_meeting(const CampaignContact& settings, const DrawnContact& contact,
                                      double time, int directions, RandomGenerator& random) {
  const Eigen::Vector3d velocity = random.uniform(0.0, settings.speed) * random_direction(directions, random);
  if ((contact.velocity - velocity).dot(contact.normal) < slowest_approach) return std::nullopt;
  const Eigen::Vector3d way = velocity * meeting_duration / peak_speed;
  DrawnMove move;
  move.position_in_base = contact.position_in_base - 0.5 * way;
  move.path = {{time - 0.5 * meeting_duration, Eigen::Vector3d::Zero()},
               {time + 0.5 * meeting_duration, way}};
  return move;
}

DrawnMove draw_push(const CampaignContact& settings, const DrawnContact& contact, double begin,
                    int directions, RandomGenerator& random) {
  const double force = random.uniform(settings.force.front(), settings.force.back());
  const double angle = random.uniform(-settings.angle, settings.angle);
  const Eigen::Vector3d any = random_direction(directions, random);
  const Eigen::Vector3d aside = (any - any.dot(contact.normal) * contact.normal).normalized();
  const Eigen::Vector3d inwards = -std::cos(angle) * contact.normal - std::sin(angle) * aside;
  const Eigen::Vector3d way = (clearance / std::cos(angle) + force / pushing_stiffness) * inwards;
  DrawnMove move;
  move.position_in_base = contact.position_in_base + clearance * contact.normal;
  const double full = begin + settings.rise, fall = full + std::max(settings.hold, 1e-3);
  move.path = {{begin, Eigen::Vector3d::Zero()},
               {full, way},
               {fall, way},
               {fall + settings.rise, Eigen::Vector3d::Zero()}};
  return move;
}

}  // namespace flinch
