#include "diagrams/task_stages.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "systems/framework/constant.h"
#include "tests/diagrams/contact_rig.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/unsure_classifier.h"

namespace flinch {
namespace {

using enum ReactionMode;
using test::Bench;
using test::collision;
using test::RigExperiment;

/// `law`, told from the start what will be touched; -1: that nobody knows.
ControlLaw told(ControlLaw law, int touched) {
  return {law.name, [law, touched](const StageContext& site, const ReactionPorts& given) {
            ContactClassification classification;
            classification.valid = classification.accepted = touched >= 0;
            classification.most_likely = touched;
            ReactionPorts known = given;
            known.classification =
                site.builder.add<Constant<ContactClassification>>(site.name + "_told", classification).value;
            return law.add(site, known);
          }};
}

class TaskStages : public ::testing::TestWithParam<int> {
 protected:
  static constexpr int strict = 3;
  ControlLaw tracking() const {
    return tracking_stages()[static_cast<std::size_t>(std::min(GetParam(), strict - 1))];
  }
  ControlLaw reaction() const { return task_reaction_stages()[static_cast<std::size_t>(GetParam())]; }
  /// Tracks and reacts on one level; the platform will be touched.
  RigExperiment experiment(double speed) const {
    RigExperiment experiment = collision(speed);
    experiment.control.stages.nominal_laws.follow(tracking());
    experiment.control.stages.reaction_laws.follow(told(reaction(), 0));
    if (GetParam() == strict) keep_constraints_strictly(*test::planar_rig(), experiment.control);
    return experiment;
  }
};

std::string level_name(const ::testing::TestParamInfo<int>& level) {
  static const std::vector<std::string> names = {"Velocity", "Acceleration", "Torque", "Strict"};
  return names[static_cast<std::size_t>(level.param)];
}
INSTANTIATE_TEST_SUITE_P(Levels, TaskStages, ::testing::Range(0, 4), level_name);

TEST_P(TaskStages, AContactIsAnsweredAndHeldUntilTheOperatorEndsIt) {
  Bench rig(experiment(0.5));
  ASSERT_TRUE(rig.run_until(react, 1500ms));
  ASSERT_TRUE(rig.run_until(hold, 1000ms));
  rig.run(200ms);
  EXPECT_EQ(rig.state().mode, hold);
  EXPECT_LT(rig.velocity().norm(), 0.01);
  rig.reset();
  rig.tick();
  EXPECT_EQ(rig.state().mode, nominal);
}

TEST_P(TaskStages, AContactThatNobodyKnowsIsAnsweredByBraking) {
  RigExperiment unknown = experiment(0.5);
  unknown.control.stages.reaction_laws = {};
  unknown.control.stages.reaction_laws.follow(reaction());
  Bench rig(unknown);
  ASSERT_TRUE(rig.run_until(react, 1500ms));
  rig.run(500ms);
  EXPECT_LT(rig.velocity().norm(), 0.02);
  EXPECT_EQ(rig.gate().phase, GatePhase::open);
}

// The whole chain with a network in it, which names the right class with a probability of 1/10.
TEST_P(TaskStages, AClassBelowTheMarginIsAnsweredAsOneThatNobodyKnows) {
  const auto comes_to_rest_at = [this](std::optional<double> accept) {
    RigExperiment doubtful = experiment(0.5);
    doubtful.control.stages.reaction_laws = {};
    doubtful.control.stages.reaction_laws.follow(accept ? reaction() : told(reaction(), -1));
    doubtful.control.stages.classifiers.follow(test::unsure_classifier(accept.value_or(1.0)));
    Bench rig(doubtful);
    EXPECT_TRUE(rig.run_until(react, 1500ms));
    const ContactClassification& said = rig.context.get(rig.control.classification);
    EXPECT_TRUE(said.valid);
    EXPECT_EQ(said.most_likely, 0);
    EXPECT_EQ(said.accepted, accept.value_or(1.0) < 0.1);
    rig.run(600ms);
    EXPECT_EQ(rig.gate().phase, GatePhase::open);
    EXPECT_LT(rig.velocity().norm(), 0.02);
    return rig.pose();
  };
  const Eigen::Vector3d unknown = comes_to_rest_at(std::nullopt);
  EXPECT_EQ(comes_to_rest_at(0.101), unknown);
  EXPECT_LT(comes_to_rest_at(0.099).x(), unknown.x() - 0.02) << "gives way along the force";
}

TEST_P(TaskStages, TheControlPathDoesNotAllocateWhileItReacts) {
  Bench rig(experiment(0.5));
  rig.run(50ms);
  const test::AllocationCounter counter;
  rig.run_until(hold, 2500ms);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_EQ(rig.state().mode, hold);
}

TEST_P(TaskStages, WhetherTheRobotCouldStopIsJudgedAtTheDetectionAndKept) {
  Bench rig(experiment(0.5));
  ASSERT_TRUE(rig.run_until(react, 1500ms));
  const BrakingStatus judged = rig.context.get(rig.control.braking);
  EXPECT_TRUE(judged.valid && judged.stays_inside);
  EXPECT_EQ(judged.judged, rig.state().since);
  EXPECT_GT(judged.duration, 0.0);
  ASSERT_TRUE(rig.run_until(hold, 1000ms));
  EXPECT_EQ(rig.context.get(rig.control.braking).judged, judged.judged);
}

TEST(BrakingMonitor, JudgesNothingWhereLimitsAreNeverKept) {
  RigExperiment experiment = collision(0.5);
  experiment.control.limits.use = SafetyFilterSettings::Use::never;
  Bench rig(experiment);
  ASSERT_TRUE(rig.run_until(react, 1500ms));
  EXPECT_FALSE(rig.context.get(rig.control.braking).valid);
}

// No switch of the sequence makes a step in the torques that the laws ask for.
TEST_P(TaskStages, TorquesNeverChangeFasterThanTheGateLetsThem) {
  Bench rig(experiment(0.5));
  JointVector before = JointVector::Zero(3);
  double largest = 0.0;
  bool passed = false;
  rig.run(2500ms, [&] {
    const TorqueCommand& asked = rig.context.get(rig.control.requested_torque);
    if (!asked.valid) return;
    if (passed) largest = std::max(largest, (asked.torque - before).lpNorm<Eigen::Infinity>());
    before = asked.torque;
    passed = true;
  });
  EXPECT_LE(largest, 20.0 + 1e-9);
  EXPECT_GT(largest, 0.0);
}

TEST_P(TaskStages, OnlyTheStrictReactionIsFollowedAtOnce) {
  Bench rig(experiment(0.5));
  const OutputPort<TorqueCommand> law{rig.diagram->tap("control/" + reaction().name + "/torque").port};
  ASSERT_TRUE(rig.run_until(react, 1500ms));
  int ticks = 1;
  while (ticks < 100 && rig.context.get(rig.control.requested_torque).torque != rig.context.get(law).torque) {
    rig.tick();
    ++ticks;
  }
  if (GetParam() == strict) {
    EXPECT_LE(ticks, 5) << "100 Nm are there after 5";
  } else {
    EXPECT_EQ(ticks, 10);
  }
}

TEST(TaskStageNames, AreKnownToScenarios) {
  const std::vector<std::string> nominal_laws = names_of(known_stages().nominal_laws);
  const std::vector<std::string> reaction_laws = names_of(known_stages().reaction_laws);
  EXPECT_THAT(nominal_laws,
              testing::IsSupersetOf({"velocity_tracking", "acceleration_tracking", "torque_tracking"}));
  EXPECT_THAT(reaction_laws, testing::IsSupersetOf({"velocity_reaction", "acceleration_reaction",
                                                    "torque_reaction", "strict_reaction"}));
}

TEST(TheStrictReaction, LetsTheSafetyFilterHoldTheSafetyValuesOfTheConstraints) {
  ContactControlSettings settings;
  settings.tasks.constraints.sigma_kappa.safety = 9.0;
  settings.tasks.constraints.sigma_sc.safety = 0.12;
  keep_constraints_strictly(*test::planar_rig(), settings);
  EXPECT_EQ(settings.limits.use, SafetyFilterSettings::Use::always);
  EXPECT_EQ(settings.limits.limits.max_condition_number, 9.0);
  EXPECT_EQ(settings.limits.limits.workspace.min_self_collision_distance, 0.12);
}

// Where each drive is at its limit, whichever way the platform moves: the least of all directions.
TEST(TheStrictReaction, LimitsThePlatformsSpeedByThatOfTheDrives) {
  const auto robot = test::planar_rig();
  ContactControlSettings settings;
  settings.limits.max_drive_speed = 7.6;
  keep_constraints_strictly(*robot, settings);
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3600; ++k) {
    const double angle = k * std::numbers::pi / 1800.0;
    Kinematics moving;
    robot->kinematics(robot->home_pose(), Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0), moving);
    least = std::min(least, 7.6 / moving.rates.active.lpNorm<Eigen::Infinity>());
  }
  EXPECT_NEAR(settings.limits.max_platform_speed, 0.58 * least, 1e-5);
  EXPECT_NEAR(settings.limits.max_platform_speed, 2.1, 0.1);
}

TEST(TheStrictReaction, NeverLoosensALimitOfTheRobot) {
  ContactControlSettings settings;
  settings.limits.max_platform_speed = 0.5;
  settings.limits.max_drive_speed = 7.6;
  settings.limits.limits.max_condition_number = 5.0;
  settings.limits.limits.workspace.min_self_collision_distance = 0.3;
  keep_constraints_strictly(*test::planar_rig(), settings);
  EXPECT_EQ(settings.limits.max_platform_speed, 0.5);
  EXPECT_EQ(settings.limits.limits.max_condition_number, 5.0);
  EXPECT_EQ(settings.limits.limits.workspace.min_self_collision_distance, 0.3);
}

}  // namespace
}  // namespace flinch
