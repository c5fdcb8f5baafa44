// How a leg opens.
#include <gtest/gtest.h>

#include "systems/robot/decompositions.h"
#include "systems/robot/reaction_tasks.h"
#include "tests/systems/motion/reaction_rig.h"

namespace flinch::test {
namespace {

/// A motion by which the elbow of the second leg bends, its first link half as fast times `advance` towards
/// what is between the links; and forces of that.
struct ClosingLeg {
  ClosingLeg(const PlanarRrr& robot, const Eigen::Vector3d& pose, double advance = 1.0) {
    const Posture still(robot, pose, Eigen::Vector3d::Zero());
    const Kinematics& at = still.kinematics;
    const double s = std::copysign(1.0, at.joints.passive[1]);
    const PlatformMatrix J = stacked(drive_task(at, 1), passive_joint_task(at, 1)).J;
    twist = J.completeOrthogonalDecomposition().solve(Eigen::Vector2d(0.5 * s * advance, s));
    force_on_link1 = at.J_qa_x.transpose() * Eigen::Vector3d(0, -10.0 * s, 0);
    const LegPoints& leg = at.legs[1];
    force_on_link2.head(2) = 20.0 * (leg.passive_joint - leg.base_joint).normalized();
  }
  Eigen::Vector3d twist;
  Eigen::Vector3d force_on_link1;                            ///< as seen at the platform
  Eigen::Vector3d force_on_link2 = Eigen::Vector3d::Zero();  ///< likewise
};

// The gap between the links is the elbow's angle against a stretched leg: |q_p| falls.
TEST(ReactionTask, AClampingLegOpensAndItsFirstLinkRetreats) {
  Reaction reaction;
  reaction.know(leg2_clamping, {20, 5, 0});
  reaction.begin();
  reaction.know(leg2_clamping, {0, 0, 0});
  const TaskGoal goal = reaction.goal();
  ASSERT_EQ(goal.task.rows(), 2);
  const double s = std::copysign(1.0, reaction.posture->kinematics.joints.passive[1]);
  EXPECT_NEAR(goal.reference.error[0], -s * 0.2094, 1e-9);
  EXPECT_NEAR(goal.reference.error[1], -2.0 * s * 0.2094, 1e-9);
}

TEST(ReactionTask, ALegMayOpenByTwoTasksOfWhichTheFirstLinksGoesBefore) {
  ReactionTaskSettings settings;
  settings.opening_by_priority = true;
  Reaction alike, by_priority(settings);
  for (Reaction* reaction : {&alike, &by_priority}) {
    reaction->know(leg2_clamping, pushing_apart);
    reaction->begin();
  }
  const TaskGoal whole = alike.go_on(5ms).goals[0];
  const TaskList& list = by_priority.go_on(5ms);
  ASSERT_EQ(list.count, 2);
  const Kinematics& at = by_priority.posture->kinematics;
  EXPECT_LT((list.goals[0].task.J - drive_task(at, 1).J).norm(), 1e-15);          // (31a)
  EXPECT_LT((list.goals[1].task.J - passive_joint_task(at, 1).J).norm(), 1e-15);  // (31b)
  for (int row = 0; row < 2; ++row) {
    const TaskGoal& goal = list.goals[static_cast<std::size_t>(row)];
    EXPECT_EQ(goal.reference.error[0], whole.reference.error[row]);
    EXPECT_EQ(goal.reference.rate[0], whole.reference.rate[row]);
    EXPECT_EQ(goal.gains.force[0], whole.gains.force[row]);
  }
}

// There was room for what it clamps before the robot came: a first link that hardly moved hardly retreats.
TEST(ReactionTask, ALegThatClosesOpensTheWayItCame) {
  const Eigen::Vector3d pose(0.02, 0.01, 0.05);
  for (const int touched : {leg2_clamping, leg2_link1, leg2_link2}) {
    for (const double retreat : {-0.5, 0.0, 0.25, 1.0, 3.0}) {
      Reaction reaction;
      const ClosingLeg leg(*reaction.robot, pose, retreat);
      reaction.know(touched, touched == leg2_link2 ? leg.force_on_link2 : leg.force_on_link1, pose,
                    leg.twist);
      reaction.begin();
      reaction.know(touched, {0, 0, 0}, pose);
      const Eigen::Vector2d goal = reaction.goal().reference.error;
      EXPECT_EQ(reaction.ticking.get(reaction.block.kind), ReactionKind::opening) << touched;
      const double s = std::copysign(1.0, reaction.posture->kinematics.joints.passive[1]);
      EXPECT_NEAR(goal[0], -s * 0.2094 * std::clamp(retreat, 0.0, 1.0), 1e-9) << touched;
      EXPECT_NEAR(goal[1], -2.0 * s * 0.2094, 1e-9) << touched;
    }
  }
}

TEST(ReactionTask, ALinkThatIsTouchedFromOutsideOfAClosingLegDoesNotOpenIt) {
  const Eigen::Vector3d pose(0.02, 0.01, 0.05);
  for (const int touched : {leg2_link1, leg2_link2}) {
    Reaction reaction;
    const ClosingLeg leg(*reaction.robot, pose);
    reaction.know(touched, touched == leg2_link2 ? -leg.force_on_link2 : -leg.force_on_link1, pose,
                  leg.twist);
    reaction.begin();
    EXPECT_EQ(reaction.ticking.get(reaction.block.kind),
              touched == leg2_link1 ? ReactionKind::first_link : ReactionKind::second_link);
  }
}

TEST(ReactionTask, AClampingLegOpensFurtherUntilNothingIsFeltForAWhile) {
  Reaction reaction;
  reaction.know(leg2_clamping, pushing_apart);
  reaction.begin();
  reaction.go_on(400ms);
  EXPECT_FALSE(reaction.finished());
  reaction.know(leg2_clamping, {1, 1, 0.1});
  reaction.go_on(99ms);
  EXPECT_FALSE(reaction.finished());
  const double opened = std::abs(reaction.goal().reference.error[0]);
  EXPECT_TRUE(reaction.finished());
  EXPECT_GT(opened, 0.2094 + 0.1047 - 1e-9);
  reaction.go_on(1000ms);
  ASSERT_TRUE(reaction.holds_a_place());
  EXPECT_LT(reaction.way_back().norm(), 1e-12);
}

// What an opening meets when it has long let go of what it clamped is not clamped by it.
TEST(ReactionTask, AReleasedLegDoesNotOpenFurtherForWhatIsFeltLater) {
  Reaction reaction;
  reaction.know(leg2_clamping, {20, 5, 0});
  reaction.begin();
  reaction.know(leg2_clamping, {0, 0, 0});
  const double opened = std::abs(reaction.goal().reference.error[0]);
  EXPECT_NEAR(opened, 0.2094, 1e-9);
  for (const double sign : {1.0, -1.0}) {
    reaction.know(leg2_clamping, {20 * sign, 5 * sign, 0});
    reaction.go_on(1000ms);
    EXPECT_EQ(reaction.ticking.get(reaction.block.kind), ReactionKind::brake) << "it yields";
  }
}

// Of two forces on the leg, one helps it to open and one stands in its way.
TEST(ReactionTask, AnOpeningGoesOnOnlyWhereWhatIsFeltDoesNotOpposeIt) {
  int furthered = 0, yielded = 0;
  for (const double sign : {1.0, -1.0}) {
    Reaction reaction;
    reaction.know(leg2_clamping, {20 * sign, 5 * sign, 0});
    const TaskList& begins = reaction.begin();
    ASSERT_EQ(begins.count, 1);
    const Kinematics& at = reaction.posture->kinematics;
    const double s = std::copysign(1.0, at.joints.passive[1]);
    const PlatformMatrix J = stacked(drive_task(at, 1), passive_joint_task(at, 1)).J;
    const Eigen::Vector3d opening = J.completeOrthogonalDecomposition().solve(Eigen::Vector2d(-s, -2.0 * s));
    const bool helps = opening.dot(Eigen::Vector3d(20 * sign, 5 * sign, 0)) > 0.0;
    reaction.go_on(400ms);
    const bool opens = reaction.ticking.get(reaction.block.kind) == ReactionKind::opening;
    EXPECT_EQ(opens, helps);
    furthered += opens ? 1 : 0;
    yielded += opens ? 0 : 1;
  }
  EXPECT_EQ(furthered, 1);
  EXPECT_EQ(yielded, 1);
}

// A wrench that is said not to be valid may be of long ago.
TEST(ReactionTask, AnOpeningGoesOnWhereNothingIsKnownOfTheForce) {
  for (const double sign : {1.0, -1.0}) {
    Reaction reaction;
    reaction.know(leg2_clamping, {20 * sign, 5 * sign, 0});
    reaction.begin();
    WrenchEstimate stale;
    stale.wrench_in_base = Eigen::Vector3d(20 * sign, 5 * sign, 0);
    stale.drive_torque = reaction.posture->kinematics.J_x_qa.transpose() * stale.wrench_in_base;
    reaction.ticking.set(reaction.estimate, stale);
    reaction.go_on(300ms);
    EXPECT_EQ(reaction.ticking.get(reaction.block.kind), ReactionKind::opening) << sign;
  }
}

TEST(ReactionTask, AnOpeningEndsAtTheLargestThoughItIsNotReleasedAndThenYields) {
  Reaction reaction;
  reaction.know(leg2_clamping, pushing_apart);
  reaction.begin();
  EXPECT_NEAR(std::abs(reaction.goal().reference.error[0]), 0.6981, 1e-9);
  double further = 0.0;
  for (int tick = 0; tick < 10000; ++tick) {
    const TaskList& list = reaction.go_on();
    if (list.count > 0) further = std::max(further, list.goals[0].reference.error.norm());
  }
  EXPECT_LT(further, 1e-12);
  EXPECT_EQ(reaction.ticking.get(reaction.block.kind), ReactionKind::brake);
  EXPECT_TRUE(reaction.finished());
}

}  // namespace
}  // namespace flinch::test
