#include "experiments/verdict/names_of_touched.h"

#include <gtest/gtest.h>

#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

TEST(NamesOfTouched, AreThoseOfBodiesAndGaps) {
  const PlanarRrr robot(rig_robot(RigGeometry::nominal, RigFriction::none));
  const std::vector<std::string> names = names_of_touched(robot);
  ASSERT_EQ(names.size(), 10U);
  EXPECT_EQ(names.front(), "platform");
  EXPECT_EQ(names[1], "leg1_link1");
  EXPECT_EQ(names[9], "leg3_clamping");
}

TEST(NamesOfTouched, SayTheLegWhereItsLinksAreAlike) {
  const std::vector<std::string> names = names_of_touched(Hexapod(hexapod_robot()));
  ASSERT_EQ(names.size(), 19U);
  EXPECT_EQ(names[0], "platform");
  EXPECT_EQ(names[1], "leg1");
  EXPECT_EQ(names[12], "leg6");
  EXPECT_EQ(names[13], "leg1_clamping");
}

TEST(WhatIsTold, IsRightOfTheBodyOrOfAnyLinkOfTheLeg) {
  EXPECT_TRUE(names_body("platform", "platform"));
  EXPECT_TRUE(names_body("leg4_link2", "leg4_link2"));
  EXPECT_TRUE(names_body("leg4", "leg4_link1"));
  EXPECT_TRUE(names_body("leg4", "leg4_link2"));
  EXPECT_TRUE(names_body("leg4", "leg4_clamping"));
  EXPECT_FALSE(names_body("leg1", "leg11_link1"));
  EXPECT_FALSE(names_body("leg4", "leg3_link1"));
  EXPECT_FALSE(names_body("leg4_link1", "leg4_link2"));
}

}  // namespace
}  // namespace flinch
