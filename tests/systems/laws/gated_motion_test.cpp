#include "systems/laws/gated_motion.h"

#include <gtest/gtest.h>

#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

using Use = SafetyFilterSettings::Use;

TEST(GatedMotion, IsThereInTheModesInWhichLimitsAreKept) {
  EXPECT_TRUE(keeps_limits_in(ReactionMode::react, Use::after_contact));
  EXPECT_TRUE(keeps_limits_in(ReactionMode::hold, Use::after_contact));
  EXPECT_TRUE(keeps_limits_in(ReactionMode::zero_g, Use::after_contact));
  EXPECT_FALSE(keeps_limits_in(ReactionMode::nominal, Use::after_contact));
  EXPECT_TRUE(keeps_limits_in(ReactionMode::nominal, Use::always));
  for (const ReactionMode mode : {ReactionMode::stopped, ReactionMode::recover})
    EXPECT_FALSE(keeps_limits_in(mode, Use::always));
  EXPECT_FALSE(keeps_limits_in(ReactionMode::react, Use::never));
}

TEST(GatedMotion, HandsTheMotionOnFromTheTickOfTheContact) {
  const test::Posture posture(*test::planar_rig(), Eigen::Vector3d(0.1, 0.0, 0.0));
  DiagramBuilder builder("test", 1ms);
  auto& block = builder.add<GatedMotion>("kept", Use::after_contact);
  const auto motion = builder.export_input("motion", block.motion);
  const auto reaction = builder.export_input("reaction", block.reaction);
  test::Ticking ticking(builder);
  ticking.set(motion, posture.platform);
  ticking.set(reaction, ReactionState{ReactionMode::nominal, ReactionMode::nominal, {}});
  ticking.tick();
  EXPECT_FALSE(ticking.get(block.kept).valid());
  ticking.set(reaction, ReactionState{ReactionMode::react, ReactionMode::nominal, {}});
  ticking.tick();
  ASSERT_TRUE(ticking.get(block.kept).valid());
  EXPECT_EQ(ticking.get(block.kept).pose, posture.platform.pose);
}

}  // namespace
}  // namespace flinch
