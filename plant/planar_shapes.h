#pragma once

#include "plant/planar_gap.h"
#include "plant/planar_pairs.h"
#include "systems/robot/body_id.h"
#include "systems/robot/planar_motion.h"

namespace flinch {

inline constexpr int planar_body_count = 7;

/// Outlines of a planar 3-RRR in its plane of motion. A body's axis begins at its proximal joint; the
/// platform is a disc about the origin of its frame.
struct PlanarShapes {
  double link_radius = 0.0;      ///< [m]
  double platform_radius = 0.0;  ///< [m]

  PlanarCapsule body(const PlanarMotion& motion, BodyId body) const noexcept;
  /// The disc of a pair of the robot's own bodies.
  Disc joint(const PlanarPair& pair, const PlanarMotion& motion) const noexcept;
  double radius(BodyId body) const noexcept { return body.is_platform() ? platform_radius : link_radius; }
};

/// The body that the disc of a pair of the robot's own bodies belongs to.
BodyId round_body(const PlanarPair& pair) noexcept;

/// Calls visit(body, gap) for the body or bodies of `pair` that `disc` may touch. Around a joint of two links
/// there is one contact: that with the nearer link. Around the coupling joint, as far as the platform's
/// outline covers the link's end, there is only the contact with the platform.
template <class Visit>
void for_each_gap(const PlanarShapes& shapes, const PlanarPair& pair, const PlanarMotion& motion,
                  const Disc& disc, Visit&& visit) {
  using Against = PlanarPair::Against;
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
