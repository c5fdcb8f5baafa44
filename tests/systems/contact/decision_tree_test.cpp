#include "systems/contact/decision_tree.h"

#include <numbers>

#include "systems/contact/feature_extraction.h"
#include "systems/foundation/setup_error.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

constexpr ContactClasses classes(7, 3);

struct Bench {
  std::shared_ptr<const PlanarRrr> robot = test::touched_bench();
  Kinematics home = test::at_home(*robot);

  int decide_on(const PlatformVector& wrench, const Kinematics& k) const {
    return decide(contact_features(*robot, k, test::estimate_of(k, wrench), {}), elbow_angles(k, 3), classes,
                  {});
  }
};

TEST(DecisionTree, TellsExactContactsApartAsFarAsItsLimitsAllow) {
  const Bench bench;
  for (int leg = 0; leg < 3; ++leg) {
    const auto on = [&](BodyId link, double fraction) {
      return bench.decide_on(test::wrench_on_link(*bench.robot, bench.home, link, fraction, {0.0, 40.0}),
                             bench.home);
    };
    EXPECT_EQ(on(BodyId::link1(leg), 0.7), ContactClasses::collision(BodyId::link1(leg)));
    EXPECT_EQ(on(BodyId::link2(leg), 0.7), ContactClasses::collision(BodyId::link2(leg)));
    // Below the cone of 35 degrees, so near the elbow, a second link looks like a first.
    EXPECT_EQ(on(BodyId::link2(leg), 0.1), ContactClasses::collision(BodyId::link1(leg)));
  }
  EXPECT_EQ(bench.decide_on(PlatformVector{{0.0, 40.0, 0.0}}, bench.home), 0);
}

TEST(DecisionTree, SeesClampingWhereTheLegIsFolded) {
  const Bench bench;
  for (const Kinematics& k : test::random_kinematics(*bench.robot, 200)) {
    const PlatformVector wrench = test::wrench_on_link(*bench.robot, k, BodyId::link2(1), 0.6, {0.0, 40.0});
    const int said = bench.decide_on(wrench, k);
    const bool folded = std::abs(k.joints.passive[1]) > 130.0 / 180.0 * std::numbers::pi;
    if (classes.leg(said) == 1) {
      EXPECT_EQ(classes.is_clamping(said), folded);
    }
  }
}

TEST(DecisionTree, PrefersOfTwoLegsThatTheLinePassesTheOneWhoseDriveFeelsMore) {
  ContactFeatures features;
  features.valid = features.has_lever = true;
  features.distance = JointVector{{0.012, 0.010, 0.3}};
  features.drive_torque = JointVector{{9.0, 3.0, 1.0}};
  features.angle = JointVector::Constant(3, 1.5);
  features.affected_drives = 2;
  const JointVector elbow = JointVector::Constant(3, 1.9);
  EXPECT_EQ(decide(features, elbow, classes, {}), ContactClasses::collision(BodyId::link2(0)));
  features.distance[0] = 0.016;
  EXPECT_EQ(decide(features, elbow, classes, {}), ContactClasses::collision(BodyId::link2(1)));
}

TEST(DecisionTree, SaysNothingOfFeaturesThatAreNotThere) {
  EXPECT_EQ(decide(ContactFeatures(), JointVector::Zero(3), classes, {}), -1);
  ContactFeatures features;
  features.valid = true;
  EXPECT_EQ(decide(features, JointVector::Zero(3), classes, {}), -1);
}

TEST(DecisionTree, AnswersAtTheDetectionAndKeepsItUntilTheContactEnds) {
  const Bench bench;
  DiagramBuilder builder;
  auto& block = builder.add<DecisionTree>("tree", bench.robot, DecisionTreeSettings{});
  const auto phase = builder.export_input("phase", block.phase);
  const auto features = builder.export_input("features", block.features);
  const auto kinematics = builder.export_input("kinematics", block.kinematics);
  test::Ticking ticking(builder);
  ticking.set(kinematics, bench.home);
  const auto see = [&](bool active, const PlatformVector& wrench) {
    ticking.set(phase, ContactPhase{active, {}});
    ticking.set(features,
                contact_features(*bench.robot, bench.home, test::estimate_of(bench.home, wrench), {}));
    ticking.tick();
    return ticking.get(block.classification);
  };
  const PlatformVector on_platform{{0.0, 40.0, 0.0}};
  const PlatformVector on_link =
      test::wrench_on_link(*bench.robot, bench.home, BodyId::link2(2), 0.8, {0.0, 40.0});
  const test::AllocationCounter allocations;
  EXPECT_FALSE(see(false, on_platform).valid);
  EXPECT_FALSE(see(true, PlatformVector::Zero(3)).valid);
  const ContactClassification first = see(true, on_platform);
  EXPECT_TRUE(first.valid && first.accepted);
  EXPECT_EQ(first.most_likely, 0);
  EXPECT_EQ(first.confidence(), 1.0);
  EXPECT_EQ(see(true, on_link).most_likely, 0);
  EXPECT_FALSE(see(false, on_link).valid);
  EXPECT_EQ(see(true, on_link).most_likely, ContactClasses::collision(BodyId::link2(2)));
  EXPECT_EQ(allocations.count(), 0);
}

TEST(DecisionTree, AsksForPositiveLimits) {
  EXPECT_THROW(DecisionTree(test::touched_bench(), {.leg_distance = 0.0}), SetupError);
}

}  // namespace
}  // namespace flinch
