#include "plant/bench_shapes.h"

#include <cstddef>

namespace flinch {
namespace {

const PlanarLeg& leg_of(const PlanarMotion& motion, int leg) {
  return motion.legs[static_cast<std::size_t>(leg)].leg;
}

}  // namespace

PlanarCapsule BenchShapes::body(const PlanarMotion& motion, BodyId body) const noexcept {
  if (body.is_platform()) {
    const Eigen::Vector2d origin = motion.pose.head<2>();
    return {origin, origin, platform_radius};
  }
  const PlanarLeg& leg = leg_of(motion, body.leg());
  if (body.is_link1()) return {leg.base_joint, leg.passive_joint, link_radius};
  return {leg.passive_joint, leg.coupling_joint, link_radius};
}

Disc BenchShapes::round(const ContactPair& pair, const PlanarMotion& motion,
                        const PylonMotion& pylon) const noexcept {
  switch (pair.round) {
    case ContactPair::Round::platform:
      return {motion.pose.head<2>(), platform_radius};
    case ContactPair::Round::base_joint:
      return {leg_of(motion, pair.round_leg).base_joint, link_radius};
    case ContactPair::Round::passive_joint:
      return {leg_of(motion, pair.round_leg).passive_joint, link_radius};
    case ContactPair::Round::coupling_joint:
      return {leg_of(motion, pair.round_leg).coupling_joint, link_radius};
    case ContactPair::Round::pylon:
      break;
  }
  return {pylon.position, pylon_radius};
}

BodyId round_body(const ContactPair& pair) noexcept {
  switch (pair.round) {
    case ContactPair::Round::base_joint:
    case ContactPair::Round::passive_joint:
      return BodyId::link1(pair.round_leg);
    case ContactPair::Round::coupling_joint:
      return BodyId::link2(pair.round_leg);
    case ContactPair::Round::pylon:
    case ContactPair::Round::platform:
      break;
  }
  return BodyId::platform();
}

}  // namespace flinch
