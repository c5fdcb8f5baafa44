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
/// links there is one contact: that with the nearer link; and around the coupling joint, inside the
/// platform's outline, that with the platform.
template <class Visit>
void for_each_gap(const BenchShapes& shapes, const ContactPair& pair, const PlanarMotion& motion,
                  const Disc& disc, Visit&& visit) {
  using Against = ContactPair::Against;
  const BodyId link1 = BodyId::link1(pair.leg);
  const BodyId link2 = BodyId::link2(pair.leg);
  if (pair.against == Against::platform) {
    visit(BodyId::platform(), gap_to_disc(shapes.body(motion, BodyId::platform()), disc));
  } else if (pair.against == Against::link1) {
    visit(link1, gap_to_disc(shapes.body(motion, link1), disc));
  } else if (pair.against == Against::link2) {
    visit(link2, gap_to_disc(shapes.body(motion, link2), disc));
  } else {
    const DiscGap to_link1 = gap_to_disc(shapes.body(motion, link1), disc);
    const DiscGap to_link2 = gap_to_disc(shapes.body(motion, link2), disc);
    const bool beyond_link1 = to_link1.fraction == 1.0;
    const bool before_link2 = to_link2.fraction == 0.0;
    const bool beyond_link2 = to_link2.fraction == 1.0;
    if (!beyond_link1) visit(link1, to_link1);
    if (!beyond_link2 && (!before_link2 || beyond_link1)) visit(link2, to_link2);
  }
}

}  // namespace flinch
