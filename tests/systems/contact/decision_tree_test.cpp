#include "systems/contact/decision_tree.h"

#include <cmath>
#include <map>
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
  std::shared_ptr<const PlanarRrr> robot = test::touched_rig();
  Kinematics home = test::at_home(*robot);

  int decide_on(const PlatformVector& wrench, const Kinematics& k) const {
    return decide(contact_features(*robot, k, test::estimate_of(k, wrench), {}), elbow_angles(k, 3), classes,
                  {});
  }
};

TEST(DecisionTree, TellsExactContactsApartAsFarAsItsLimitsAllow) {
  const Bench rig;
  for (int leg = 0; leg < 3; ++leg) {
    const auto on = [&](BodyId link, double fraction) {
      return rig.decide_on(test::wrench_on_link(*rig.robot, rig.home, link, fraction, {0.0, 40.0}), rig.home);
    };
    EXPECT_EQ(on(BodyId::link1(leg), 0.7), ContactClasses::collision(BodyId::link1(leg)));
    EXPECT_EQ(on(BodyId::link2(leg), 0.7), ContactClasses::collision(BodyId::link2(leg)));
    // Below the cone of 35 degrees, so near the elbow, a second link looks like a first.
    EXPECT_EQ(on(BodyId::link2(leg), 0.1), ContactClasses::collision(BodyId::link1(leg)));
  }
  EXPECT_EQ(rig.decide_on(PlatformVector{{0.0, 40.0, 0.0}}, rig.home), 0);
}

TEST(DecisionTree, SeesClampingWhereTheLegIsFolded) {
  const Bench rig;
  for (const Kinematics& k : test::random_kinematics(*rig.robot, 200)) {
    const PlatformVector wrench = test::wrench_on_link(*rig.robot, k, BodyId::link2(1), 0.6, {0.0, 40.0});
    const int said = rig.decide_on(wrench, k);
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

struct Tree {
  explicit Tree(const DecisionTreeSettings& settings = {})
      : block(builder.add<DecisionTree>("tree", rig.robot, settings)),
        phase(builder.export_input("phase", block.phase)),
        features(builder.export_input("features", block.features)),
        kinematics(builder.export_input("kinematics", block.kinematics)),
        ticking(builder) {}

  ContactClassification see(bool active, const PlatformVector& wrench, const Kinematics& k) {
    ticking.set(kinematics, k);
    ticking.set(phase, ContactPhase{active, {}});
    ticking.set(features, contact_features(*rig.robot, k, test::estimate_of(k, wrench), {}));
    ticking.tick();
    return ticking.get(block.classification);
  }
  ContactClassification see(bool active, const PlatformVector& wrench) {
    return see(active, wrench, rig.home);
  }

  Bench rig;
  DiagramBuilder builder;
  DecisionTree& block;
  InputPort<ContactPhase> phase;
  InputPort<ContactFeatures> features;
  InputPort<Kinematics> kinematics;
  test::Ticking ticking;
};

TEST(DecisionTree, IsAsSureAsAnswersOfThatSortAreRight) {
  const DecisionTreeSettings settings{.right_of_platform = 0.8,
                                      .right_of_link1 = 0.6,
                                      .right_of_link2 = 0.5,
                                      .right_of_clamping = 0.3,
                                      .accept = 0.6};
  Tree tree(settings);
  std::map<int, int> said;
  for (const Kinematics& k : test::random_kinematics(*tree.rig.robot, 200)) {
    for (const double fraction : {0.1, 0.7}) {
      const PlatformVector push =
          test::wrench_on_link(*tree.rig.robot, k, BodyId::link2(1), fraction, {0.0, 40.0});
      for (const PlatformVector& wrench : {push, PlatformVector(PlatformVector{{0.0, 40.0, 0.0}})}) {
        tree.see(false, wrench, k);
        const ContactClassification answer = tree.see(true, wrench, k);
        ASSERT_TRUE(answer.valid);
        const int number = answer.most_likely;
        const BodyId body = BodyId::from_index(number);
        const double right = classes.is_clamping(number) ? 0.3
                             : body.is_platform()        ? 0.8
                             : body.is_link1()           ? 0.6
                                                         : 0.5;
        EXPECT_EQ(answer.confidence(), right);
        EXPECT_EQ(answer.accepted, right >= settings.accept);
        ASSERT_EQ(answer.probability.size(), classes.count());
        EXPECT_NEAR(answer.probability.sum(), 1.0, 1e-12);
        EXPECT_NEAR(answer.probability[(number + 1) % classes.count()], (1.0 - right) / 9.0, 1e-15);
        ++said[static_cast<int>(std::lround(10.0 * right))];
      }
    }
  }
  EXPECT_EQ(said.size(), 4U) << "an answer of every sort";
}

TEST(DecisionTree, IsByDefaultNotActedUponButOfThePlatform) {
  const DecisionTreeSettings settings;
  EXPECT_GE(settings.right_of_platform, settings.accept);
  for (const double right : {settings.right_of_link1, settings.right_of_link2, settings.right_of_clamping})
    EXPECT_LT(right, settings.accept);
}

TEST(DecisionTree, AnswersAtTheDetectionAndKeepsItUntilTheContactEnds) {
  Tree tree;
  const Bench& rig = tree.rig;
  const auto see = [&](bool active, const PlatformVector& wrench) { return tree.see(active, wrench); };
  const PlatformVector on_platform{{0.0, 40.0, 0.0}};
  const PlatformVector on_link =
      test::wrench_on_link(*rig.robot, rig.home, BodyId::link2(2), 0.8, {0.0, 40.0});
  const test::AllocationCounter allocations;
  EXPECT_FALSE(see(false, on_platform).valid);
  EXPECT_FALSE(see(true, PlatformVector::Zero(3)).valid);
  const ContactClassification first = see(true, on_platform);
  EXPECT_TRUE(first.valid);
  EXPECT_EQ(first.most_likely, 0);
  EXPECT_EQ(see(true, on_link).most_likely, 0);
  EXPECT_FALSE(see(false, on_link).valid);
  EXPECT_EQ(see(true, on_link).most_likely, ContactClasses::collision(BodyId::link2(2)));
  EXPECT_EQ(allocations.count(), 0);
}

TEST(DecisionTree, AsksForPositiveLimitsAndShares) {
  const auto robot = test::touched_rig();
  EXPECT_THROW(DecisionTree(robot, {.leg_distance = 0.0}), SetupError);
  EXPECT_THROW(DecisionTree(robot, {.right_of_link1 = 1.1}), SetupError);
  EXPECT_THROW(DecisionTree(robot, {.right_of_clamping = std::nan("")}), SetupError);
  EXPECT_THROW(DecisionTree(robot, {.accept = 0.0}), SetupError);
}

}  // namespace
}  // namespace flinch
