#include "systems/motion/constraint_monitor.h"

#include <gtest/gtest.h>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

using Role = ConstraintMonitor::Role;

struct Watch {
  explicit Watch(const ConstraintSettings& settings = {}, Role role = Role::reacting)
      : robot(test::planar_rig()),
        block(builder.add<ConstraintMonitor>("watch", robot, settings, role)),
        reaction(builder.export_input("reaction", block.reaction)),
        kinematics(builder.export_input("kinematics", block.kinematics)) {}

  const ConstraintState& at(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity = {0, 0, 0},
                            ReactionMode mode = ReactionMode::react) {
    if (mode != state.mode) state = {mode, state.mode, ticking.now()};
    ticking.set(reaction, state);
    Kinematics now;
    robot->kinematics(pose, velocity, now);
    ticking.set(kinematics, now);
    ticking.tick();
    return ticking.get(block.constraints);
  }
  const TaskGoal& goal(int index) { return ticking.get(block.goals).goals[static_cast<std::size_t>(index)]; }

  std::shared_ptr<const PlanarRrr> robot;
  DiagramBuilder builder{"test", 1ms};
  ConstraintMonitor& block;
  InputPort<ReactionState> reaction;
  InputPort<Kinematics> kinematics;
  ReactionState state;
  test::Ticking ticking{builder};
};

// Turned to positive angles the nominal robot comes near a type-II singularity, to negative ones near itself.
const Eigen::Vector3d inside(0.0, 0.0, 0.1);
const Eigen::Vector3d near_singularity(0.0, 0.0, 0.40);
const Eigen::Vector3d near_itself(0.0, 0.0, -0.35);

TEST(ConstraintMonitor, TheTestsPosesAreWhatTheyAreCalled) {
  Watch watch;
  const ConstraintState home = watch.at(inside);
  EXPECT_LT(home.sigma_kappa.sigma, 12.0);
  EXPECT_GT(home.sigma_sc.sigma, 0.178);
  const ConstraintState singular = watch.at(near_singularity);
  EXPECT_GT(singular.sigma_kappa.sigma, 12.0);
  const ConstraintState collision = watch.at(near_itself);
  EXPECT_LT(collision.sigma_sc.sigma, 0.178);
}

TEST(ConstraintMonitor, InsideNothingIsActive) {
  Watch watch;
  const ConstraintState state = watch.at(inside);
  EXPECT_TRUE(state.valid);
  EXPECT_TRUE(state.watched);
  EXPECT_EQ(state.mode, ConstraintMode::none);
}

TEST(ConstraintMonitor, AMeasureBeyondItsActivationValueIsActiveAndBringsItsMode) {
  Watch watch;
  EXPECT_EQ(watch.at(near_singularity).mode, ConstraintMode::condition_number);
  Watch other;
  EXPECT_EQ(other.at(near_itself).mode, ConstraintMode::self_collision);
  EXPECT_EQ(other.at(near_singularity).mode, ConstraintMode::condition_number_and_self_collision);
}

TEST(ConstraintMonitor, TheReferenceGlidesFromTheMeasureToTheSafetyValueWithoutAStep) {
  Watch watch;
  const Eigen::Vector3d velocity(0.0, 0.0, 0.5);
  double before = watch.at(near_singularity, velocity).sigma_kappa.reference;
  EXPECT_NEAR(before, watch.at(near_singularity, velocity).sigma_kappa.sigma, 0.1);
  for (int tick = 0; tick < 1000; ++tick) {
    const double now = watch.at(near_singularity, velocity).sigma_kappa.reference;
    EXPECT_LT(std::abs(now - before), 0.031);  // 30/s
    before = now;
  }
  EXPECT_DOUBLE_EQ(before, 15.0);
}

TEST(ConstraintMonitor, AFastMeasureIsTakenOverAtTheSpeedOfTheGlide) {
  Watch watch;
  watch.at(near_singularity, Eigen::Vector3d(0.0, 0.0, 5.0));
  EXPECT_GT(watch.ticking.get(watch.block.constraints).sigma_kappa.rate, 30.0);
  EXPECT_DOUBLE_EQ(watch.goal(0).reference.rate[0], 30.0);
}

TEST(ConstraintMonitor, AnActiveMeasureIsLetGoWhenItHasBeenInsideForTheDwell) {
  Watch watch;
  watch.at(near_singularity);
  for (int tick = 0; tick < 49; ++tick) {
    EXPECT_EQ(watch.at(inside).mode, ConstraintMode::condition_number) << tick;
  }
  EXPECT_EQ(watch.at(inside).mode, ConstraintMode::none);
}

TEST(ConstraintMonitor, AMeasureThatLeavesAgainBeforeStaysActive) {
  Watch watch;
  watch.at(near_singularity);
  for (int tick = 0; tick < 200; ++tick) {
    EXPECT_EQ(watch.at(tick % 40 == 0 ? near_singularity : inside).mode, ConstraintMode::condition_number);
  }
}

TEST(ConstraintMonitor, InHoldAMeasureInsideItsSafetyValueIsKeptWhereItIs) {
  const Eigen::Vector3d towards(0.0, 0.0, 0.5);
  for (const bool was_active : {true, false}) {
    Watch watch;
    for (int tick = 0; tick < 50; ++tick) watch.at(was_active ? near_singularity : inside, towards);
    const ReactionMode hold = ReactionMode::hold;
    if (!was_active) watch.at(inside, towards, hold);
    const double sigma = watch.at(near_singularity, towards, hold).sigma_kappa.sigma;
    EXPECT_LT(sigma, 15.0);
    for (int tick = 0; tick < 100; ++tick) {
      const ConstraintMeasure held = watch.at(near_singularity, towards, hold).sigma_kappa;
      EXPECT_TRUE(held.active);
      EXPECT_NEAR(held.reference, sigma, 1e-12) << was_active;
      EXPECT_NEAR(watch.goal(0).reference.rate[0], 0.0, 1e-12) << was_active;
    }
  }
}

TEST(ConstraintMonitor, AReactionThatIsTakenUpAnewLeadsAMeasureOnFromWhereHoldKeptIt) {
  const ConstraintSettings settings;
  Watch watch(settings);
  watch.at(near_singularity);
  const double held = watch.at(near_singularity, {0, 0, 0}, ReactionMode::hold).sigma_kappa.reference;
  for (int tick = 0; tick < 100; ++tick) watch.at(near_singularity, {0, 0, 0}, ReactionMode::hold);
  double before = watch.at(near_singularity).sigma_kappa.reference;
  EXPECT_NEAR(before, held, 1e-12) << "without a step";
  EXPECT_NEAR(watch.goal(0).reference.rate[0], 0.0, 1e-12);
  for (int tick = 0; tick < 1000; ++tick) {
    const double now = watch.at(near_singularity).sigma_kappa.reference;
    EXPECT_LT(std::abs(now - before), 1.01e-3 * settings.sigma_kappa.glide.velocity);
    before = now;
  }
  EXPECT_DOUBLE_EQ(before, settings.sigma_kappa.safety);
}

TEST(ConstraintMonitor, InHoldAMeasureBeyondItsSafetyValueIsLedBack) {
  const Eigen::Vector3d beyond(0.0, 0.0, -0.45);
  Watch watch;
  watch.at(beyond);
  EXPECT_LT(watch.at(beyond, {0, 0, 0}, ReactionMode::hold).sigma_sc.sigma, 0.17);
  for (int tick = 0; tick < 400; ++tick) watch.at(beyond, {0, 0, 0}, ReactionMode::hold);
  EXPECT_DOUBLE_EQ(watch.at(beyond, {0, 0, 0}, ReactionMode::hold).sigma_sc.reference, 0.17);
}

// A place that is held beyond the activation value would make it active again and again, docs/theory.md.
TEST(ConstraintMonitor, InHoldNothingIsLetGoThatIsActive) {
  Watch watch;
  watch.at(near_singularity);
  for (int tick = 0; tick < 200; ++tick) {
    EXPECT_EQ(watch.at(inside, {0, 0, 0}, ReactionMode::hold).mode, ConstraintMode::condition_number) << tick;
  }
  EXPECT_EQ(watch.at(inside, {0, 0, 0}, ReactionMode::react).mode, ConstraintMode::none);
  Watch never_left;
  EXPECT_EQ(never_left.at(inside, {0, 0, 0}, ReactionMode::hold).mode, ConstraintMode::none);
}

TEST(ConstraintMonitor, WatchesAsItsSettingsSay) {
  const auto is_active = [](ConstraintsKept kept, Role role, ReactionMode mode) {
    ConstraintSettings settings;
    settings.kept = kept;
    Watch watch(settings, role);
    return watch.at(near_singularity, {0, 0, 0}, mode).sigma_kappa.active;
  };
  using enum ConstraintsKept;
  using enum ReactionMode;
  EXPECT_FALSE(is_active(never, Role::reacting, react));
  EXPECT_TRUE(is_active(after_contact, Role::reacting, react));
  EXPECT_TRUE(is_active(after_contact, Role::reacting, hold));
  EXPECT_FALSE(is_active(after_contact, Role::reacting, ReactionMode::nominal));  // the user has ended it
  EXPECT_FALSE(is_active(after_contact, Role::nominal, ReactionMode::nominal));
  EXPECT_TRUE(is_active(always, Role::nominal, ReactionMode::nominal));
  EXPECT_TRUE(is_active(always, Role::reacting, react));
  EXPECT_FALSE(is_active(always, Role::reacting, zero_g));
}

TEST(ConstraintMonitor, WhereTheKinematicsIsNotValidNothingIsActive) {
  Watch watch;
  watch.at(near_singularity);
  const ConstraintState state = watch.at(Eigen::Vector3d(9, 9, 9));
  EXPECT_FALSE(state.valid);
  EXPECT_EQ(state.mode, ConstraintMode::none);
  EXPECT_FALSE(watch.goal(0).task.valid);
}

TEST(ConstraintMonitor, RefusesLimitsThatLieTheWrongWayRound) {
  const auto robot = test::planar_rig();
  DiagramBuilder builder("test", 1ms);
  ConstraintSettings kappa;
  kappa.sigma_kappa.safety = 11.0;
  EXPECT_THROW(builder.add<ConstraintMonitor>("watch", robot, kappa, Role::reacting), SetupError);
  ConstraintSettings distance;
  distance.sigma_sc.activation = 0.1;
  EXPECT_THROW(builder.add<ConstraintMonitor>("watch", robot, distance, Role::reacting), SetupError);
}

TEST(ConstraintMonitor, DoesNotAllocate) {
  Watch watch;
  watch.at(inside);
  const test::AllocationCounter counter;
  for (int tick = 0; tick < 20; ++tick) watch.at(tick % 2 == 0 ? near_singularity : near_itself);
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace flinch
