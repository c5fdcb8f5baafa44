#include "systems/laws/task_controller.h"

#include <gtest/gtest.h>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "systems/robot/constraint_tasks.h"
#include "systems/robot/reaction_tasks.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr std::array levels{TaskLevel::velocity, TaskLevel::acceleration, TaskLevel::torque};

PlatformVector one(double value) { return PlatformVector::Constant(1, value); }

/// A controller at one posture, whose constraints are active as a test says.
struct Controller {
  explicit Controller(TaskLevel level, double torque_rate = 1e9)
      : block(builder.add<TaskController>("controller", robot, settings_of(level, torque_rate))) {
    const test::Posture posture(*robot, Eigen::Vector3d(0.05, 0.02, 0.1), Eigen::Vector3d(0.3, -0.2, 0.5));
    ticking.set(kinematics, posture.kinematics);
    ticking.set(dynamics, posture.dynamics);
    TaskList list;
    list.valid = true;
    list.add({platform_position_task(*robot, posture.kinematics),
              {Eigen::Vector2d(0.01, -0.02), Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()},
              TaskGains::uniform(2, 30, 2000, 50, 2000, 1)});
    ticking.set(tasks, list);
    TaskList kept;
    const NearbyPlaces nearby;
    kept.add({condition_number_task(*robot, posture.kinematics, nearby),
              {one(1.0), one(0.0), one(0.0)},
              TaskGains::uniform(1, 20, 1500, 62.5, 1, 2)});
    kept.add({drive_task(posture.kinematics, 1),
              {one(0.02), one(0.0), one(0.0)},
              TaskGains::uniform(1, 30, 1500, 100, 1600, 2)});
    ticking.set(constraint_goals, kept);
  }

  JointVector at(ConstraintMode mode) {
    ConstraintState state;
    state.mode = mode;
    ticking.set(constraints, state);
    ticking.tick();
    EXPECT_TRUE(ticking.get(block.torque).valid);
    return ticking.get(block.torque).torque;
  }
  JointVector settled(ConstraintMode mode) {
    for (int tick = 0; tick < 20; ++tick) at(mode);
    return at(mode);
  }

  static TaskControllerSettings settings_of(TaskLevel level, double torque_rate) {
    TaskControllerSettings settings;
    settings.level = level;
    settings.levels.largest_torque_rate = torque_rate;
    return settings;
  }

  std::shared_ptr<const PlanarRrr> robot = test::planar_rig();
  DiagramBuilder builder{"test", 1ms};
  TaskController& block;
  InputPort<TaskList> tasks = builder.export_input("tasks", block.tasks);
  InputPort<TaskList> constraint_goals = builder.export_input("constraint_goals", block.constraint_goals);
  InputPort<ConstraintState> constraints = builder.export_input("constraints", block.constraints);
  InputPort<Kinematics> kinematics = builder.export_input("kinematics", block.kinematics);
  InputPort<Dynamics> dynamics = builder.export_input("dynamics", block.dynamics);
  test::Ticking ticking{builder};
};

TEST(TaskController, EachConstraintModeAsksForTorquesOfItsOwn) {
  using enum ConstraintMode;
  for (const TaskLevel level : levels) {
    Controller controller(level);
    const JointVector none_torque = controller.settled(none);
    const JointVector kappa = controller.settled(condition_number);
    const JointVector distance = controller.settled(self_collision);
    const JointVector both = controller.settled(condition_number_and_self_collision);
    EXPECT_GT((kappa - none_torque).norm(), 1.0);
    EXPECT_GT((distance - none_torque).norm(), 1.0);
    EXPECT_GT((both - kappa).norm(), 0.1);
    EXPECT_LT((controller.settled(none) - none_torque).norm(), 1e-9);
  }
}

TEST(TaskController, AChangeOfModeIsBlendedInTenEqualSteps) {
  using enum ConstraintMode;
  Controller controller(TaskLevel::torque);
  const JointVector from = controller.settled(none);
  const JointVector to = Controller(TaskLevel::torque).settled(condition_number);
  for (int tick = 1; tick <= 10; ++tick) {
    const JointVector now = controller.at(condition_number);
    EXPECT_LT((now - (from + 0.1 * tick * (to - from))).norm(), 1e-9) << tick;
  }
}

// The continuity law: whatever switches during a blend, no tick changes by more than one step of a blend.
TEST(TaskController, ASecondSwitchDuringABlendMakesNoStep) {
  using enum ConstraintMode;
  for (const TaskLevel level : levels) {
    double furthest = 0.0;
    {
      Controller controller(level);
      std::vector<JointVector> ends;
      for (const ConstraintMode mode :
           {none, condition_number, self_collision, condition_number_and_self_collision})
        ends.push_back(controller.settled(mode));
      for (const JointVector& a : ends)
        for (const JointVector& b : ends) furthest = std::max(furthest, (a - b).norm());
    }
    Controller controller(level);
    JointVector before = controller.settled(none);
    const std::array switches{condition_number, self_collision, none, condition_number_and_self_collision,
                              condition_number};
    for (const ConstraintMode mode : switches) {
      for (int tick = 0; tick < 4; ++tick) {
        const JointVector now = controller.at(mode);
        EXPECT_LE((now - before).norm(), 0.1 * furthest + 1e-9);
        before = now;
      }
    }
  }
}

TEST(TaskController, TorquesChangeNoFasterThanTheLargestRateAndInTheDirectionOfTheChange) {
  using enum ConstraintMode;
  Controller controller(TaskLevel::acceleration, 1000.0);
  const JointVector from = controller.settled(none);
  const JointVector to = Controller(TaskLevel::acceleration).settled(self_collision);
  JointVector before = from;
  for (int tick = 0; tick < 10; ++tick) {
    const JointVector now = controller.at(self_collision);
    EXPECT_LE((now - before).lpNorm<Eigen::Infinity>(), 1.0 + 1e-12);
    before = now;
  }
  EXPECT_NEAR((before - from).normalized().dot((to - from).normalized()), 1.0, 1e-9);
}

TEST(TaskController, WithoutAListOrAModelItIsNotValid) {
  Controller controller(TaskLevel::torque);
  controller.at(ConstraintMode::none);
  controller.ticking.set(controller.tasks, TaskList());
  controller.ticking.tick();
  EXPECT_FALSE(controller.ticking.get(controller.block.torque).valid);
  Controller other(TaskLevel::torque);
  other.ticking.set(other.dynamics, Dynamics());
  other.ticking.tick();
  EXPECT_FALSE(other.ticking.get(other.block.torque).valid);
}

TEST(TaskController, RefusesSettingsThatAreNotPositive) {
  DiagramBuilder builder("test", 1ms);
  TaskControllerSettings settings;
  settings.levels.free_damping = 0.0;
  EXPECT_THROW(builder.add<TaskController>("a", test::planar_rig(), settings), SetupError);
  settings = {};
  settings.blend = -1ms;
  EXPECT_THROW(builder.add<TaskController>("b", test::planar_rig(), settings), SetupError);
}

TEST(TaskController, DoesNotAllocateWhileItBlends) {
  for (const TaskLevel level : levels) {
    Controller controller(level);
    controller.at(ConstraintMode::none);
    ConstraintState state;
    state.mode = ConstraintMode::condition_number_and_self_collision;
    controller.ticking.set(controller.constraints, state);
    const test::AllocationCounter counter;
    for (int tick = 0; tick < 5; ++tick) controller.ticking.tick();
    EXPECT_EQ(counter.count(), 0);
  }
}

}  // namespace
}  // namespace flinch
