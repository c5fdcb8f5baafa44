#pragma once

#include "plant/contact_pairs.h"
#include "plant/planar_gap.h"
#include "plant/pylon.h"
#include "systems/robot/body_id.h"
#include "systems/robot/planar_motion.h"

namespace flinch {

/// Outlines of the robot's bodies and of the pylon in the plane of motion. A body's axis begins at its
/// proximal joint; the platform is a disc about the origin of its frame.
struct BenchShapes {
  double link_radius = 0.0;      ///< [m]
  double platform_radius = 0.0;  ///< [m]
  double pylon_radius = 0.0;     ///< [m]

  PlanarCapsule body(const PlanarMotion& motion, BodyId body) const noexcept;
  Disc round(const ContactPair& pair, const PlanarMotion& motion, const PylonMotion& pylon) const noexcept;
};

/// The body that a pair's disc belongs to; the pylon belongs to none, for which this is the platform.
BodyId round_body(const ContactPair& pair) noexcept;

/// Calls visit(body, gap) for the body or bodies of `pair` that its disc may touch. Around a joint of two
/// links there is one contact: that with the nearer link. Around the coupling joint, as far as the platform's
/// outline covers the link's end, there is only the contact with the platform.
template <class Visit>
void for_each_gap(const BenchShapes& shapes, const ContactPair& pair, const PlanarMotion& motion,
                  const Disc& disc, Visit&& visit) {
  using Against = ContactPair::Against;
  const BodyId link1 = BodyId::link1(pair.leg);
  const BodyId link2 = BodyId::link2(pair.leg);
  const auto gap_to = [&](BodyId body) { return gap_to_disc(shapes.body(motion, body), disc); };
  if (pair.against == Against::platform) {
    visit(BodyId::platform(), gap_to(BodyId::platform()));
  } else if (pair.against == Against::link1) {
    visit(link1, gap_to(link1));
  } else if (pair.against == Against::link2) {
    visit(link2, gap_to(link2));
  } else {
    const DiscGap to_link1 = gap_to(link1);
    const DiscGap to_link2 = gap_to(link2);
    const bool beyond_link1 = to_link1.fraction == 1.0;
    const bool before_link2 = to_link2.fraction == 0.0;
    const bool covered = to_link2.fraction == 1.0 && gap_to(BodyId::platform()).gap < to_link2.gap + 1e-9;
    if (!beyond_link1) visit(link1, to_link1);
    if (!covered && (!before_link2 || beyond_link1)) visit(link2, to_link2);
  }
}

}  // namespace flinch
