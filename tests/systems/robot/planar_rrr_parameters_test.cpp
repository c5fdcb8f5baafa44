#include "systems/robot/planar_rrr_parameters.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch::test {
namespace {

PlanarRrrParameters good() { return rig_robot(RigGeometry::individual, RigFriction::test_rig); }

TEST(PlanarRrrParameters, ThatArePublishedHaveNoProblems) {
  for (const RigGeometry geometry : {RigGeometry::individual, RigGeometry::nominal}) {
    for (const RigFriction friction : {RigFriction::none, RigFriction::test_rig, RigFriction::simulation}) {
      EXPECT_TRUE(problems(rig_robot(geometry, friction)).empty());
    }
  }
}

TEST(PlanarRrrParameters, EveryBadFieldIsReportedByItsPath) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Spoil = std::function<void(PlanarRrrParameters&)>;
  const std::pair<const char*, Spoil> cases[] = {
      {"name", [](auto& p) { p.name.clear(); }},
      {"legs[1].link1_length", [](auto& p) { p.legs[1].link1_length = 0.0; }},
      {"legs[2].link2_length", [](auto& p) { p.legs[2].link2_length = -0.6; }},
      {"legs[0].base_radius", [&](auto& p) { p.legs[0].base_radius = nan; }},
      {"legs[0].base_angle", [&](auto& p) { p.legs[0].base_angle = nan; }},
      {"legs[0].coupling_angle", [&](auto& p) { p.legs[0].coupling_angle = nan; }},
      {"legs[1].elbow_sign", [](auto& p) { p.legs[1].elbow_sign = 0; }},
      {"legs[1].inertia.p1", [](auto& p) { p.legs[1].inertia.p1 = -0.1; }},
      {"legs[1].inertia.p2", [](auto& p) { p.legs[1].inertia.p2 = 0.0; }},
      {"legs[1].inertia.p3", [](auto& p) { p.legs[1].inertia.p3 = -0.1; }},
      {"legs[1].inertia has", [](auto& p) { p.legs[1].inertia.p3 = 0.5; }},
      {"legs[1].inertia has", [](auto& p) { p.legs[1].inertia.p1 = p.legs[1].inertia.p2; }},
      {"legs[2].rotor_inertia", [](auto& p) { p.legs[2].rotor_inertia = -1e-3; }},
      {"legs[2].active_friction.viscous", [](auto& p) { p.legs[2].active_friction.viscous = -1.0; }},
      {"legs[2].passive_friction.coulomb", [&](auto& p) { p.legs[2].passive_friction.coulomb = nan; }},
      {"coupling_radius", [](auto& p) { p.coupling_radius = 0.0; }},
      {"platform_mass", [](auto& p) { p.platform_mass = -0.642; }},
      {"platform_inertia", [](auto& p) { p.platform_inertia = 0.0; }},
      {"platform_hull_radius", [](auto& p) { p.platform_hull_radius = 0.0; }},
      {"link_radius", [](auto& p) { p.link_radius = 0.0; }},
      {"friction_velocity", [](auto& p) { p.friction_velocity = 0.0; }},
      {"gravity[0]", [](auto& p) { p.gravity.x() = 9.81; }},
      {"gravity[1]", [&](auto& p) { p.gravity.y() = nan; }},
      {"gravity[2]", [&](auto& p) { p.gravity.z() = nan; }},
      {"home_pose[2]", [&](auto& p) { p.home_pose.z() = nan; }},
      {"home_pose is out of reach of legs[0]", [](auto& p) { p.home_pose.x() = 0.6; }},
  };
  for (const auto& [path, spoil] : cases) {
    PlanarRrrParameters parameters = good();
    spoil(parameters);
    const std::vector<std::string> found = problems(parameters);
    ASSERT_EQ(found.size(), 1u) << path;
    EXPECT_EQ(found[0].rfind(path, 0), 0u) << found[0];
    EXPECT_THROW(PlanarRrr robot(parameters), SetupError) << path;
  }
}

TEST(PlanarRrrParameters, SentencesSayWhatWasFoundAndWhatIsRight) {
  PlanarRrrParameters parameters = good();
  parameters.legs[1].link1_length = 0.0;
  EXPECT_EQ(problems(parameters).at(0), "legs[1].link1_length is 0 m; it must be positive");
}

TEST(PlanarRrrParameters, AllProblemsAreReportedAtOnce) {
  PlanarRrrParameters parameters = good();
  parameters.platform_mass = -1.0;
  parameters.legs[0].link1_length = 0.0;
  parameters.legs[2].elbow_sign = 3;
  try {
    const PlanarRrr robot(parameters);
    FAIL() << "accepted";
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 3u);
  }
  EXPECT_GT(problems(PlanarRrrParameters()).size(), 10u);
}

TEST(PlanarRrrParameters, HomePoseMayBeAnywhereInReach) {
  PlanarRrrParameters parameters = good();
  parameters.home_pose = {0.1, -0.05, 0.2};
  EXPECT_TRUE(problems(parameters).empty());
}

TEST(BaseParameters, OfThePublishedBodiesAreThePublishedOnes) {
  const LegInertia inertia = base_parameters(rig_link1(), rig_link2(), 0.5816);
  EXPECT_NEAR(inertia.p1, 0.605363, 5e-7);
  EXPECT_NEAR(inertia.p2, 0.0965503, 5e-8);
  EXPECT_NEAR(inertia.p3, 0.1356582, 5e-8);
  EXPECT_NEAR(rig_link1().inertia, 0.06404, 5e-6);
  EXPECT_NEAR(rig_link2().inertia, 0.02401, 5e-6);
}

TEST(RigFrictionPreset, IsRescaledToTheTorqueConstantsOfToday) {
  const PlanarRrrParameters rig = good();
  const double viscous[] = {0.00165, 0.00076, 0.00107};
  const double coulomb[] = {0.5650, 0.6447, 0.5904};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(rig.legs[i].active_friction.viscous, viscous[i], 5.1e-6);
    EXPECT_NEAR(rig.legs[i].active_friction.coulomb, coulomb[i], 5.1e-5);
  }
  EXPECT_EQ(rig.legs[1].passive_friction.viscous, 0.2236);
  EXPECT_EQ(rig.legs[1].passive_friction.coulomb, 0.0381);
  const PlanarRrrParameters simulated = rig_robot(RigGeometry::nominal, RigFriction::simulation);
  EXPECT_EQ(simulated.legs[2].active_friction.viscous, 1.0);
  EXPECT_EQ(simulated.legs[2].active_friction.coulomb, 0.0);
}

}  // namespace
}  // namespace flinch::test
