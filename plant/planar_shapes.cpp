#include "plant/planar_shapes.h"

#include <cstddef>

namespace flinch {
namespace {

const PlanarLeg& leg_of(const PlanarMotion& motion, int leg) {
  return motion.legs[static_cast<std::size_t>(leg)].leg;
}

}  // namespace

PlanarCapsule PlanarShapes::body(const PlanarMotion& motion, BodyId body) const noexcept {
  if (body.is_platform()) {
    const Eigen::Vector2d origin = motion.pose.head<2>();
    return {origin, origin, platform_radius};
  }
  const PlanarLeg& leg = leg_of(motion, body.leg());
  if (body.is_link1()) return {leg.base_joint, leg.passive_joint, link_radius};
  return {leg.passive_joint, leg.coupling_joint, link_radius};
}

Disc PlanarShapes::joint(const PlanarPair& pair, const PlanarMotion& motion) const noexcept {
  switch (pair.round) {
    case PlanarPair::Round::base_joint:
      return {leg_of(motion, pair.which).base_joint, link_radius};
    case PlanarPair::Round::passive_joint:
      return {leg_of(motion, pair.which).passive_joint, link_radius};
    case PlanarPair::Round::coupling_joint:
      return {leg_of(motion, pair.which).coupling_joint, link_radius};
    case PlanarPair::Round::obstacle:
    case PlanarPair::Round::platform:
      break;
  }
  return {motion.pose.head<2>(), platform_radius};
}

BodyId round_body(const PlanarPair& pair) noexcept {
  switch (pair.round) {
    case PlanarPair::Round::base_joint:
    case PlanarPair::Round::passive_joint:
      return BodyId::link1(pair.which);
    case PlanarPair::Round::coupling_joint:
      return BodyId::link2(pair.which);
    case PlanarPair::Round::obstacle:
    case PlanarPair::Round::platform:
      break;
  }
  return BodyId::platform();
}

}  // namespace flinch
