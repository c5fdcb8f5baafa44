#include "systems/laws/task_energy.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "systems/framework/diagram_builder.h"
#include "systems/framework/random.h"
#include "systems/laws/task_level.h"
#include "systems/robot/forward_dynamics.h"
#include "systems/robot/impedance_damping.h"
#include "systems/robot/reaction_tasks.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"
#include "tests/systems/laws/task_level_trial.h"
#include "tests/systems/robot/residual.h"

namespace flinch {
namespace {

using test::Residual;

class TaskEnergyOf : public test::TaskLevelTrial {
 protected:
  TaskEnergyOf() : TaskLevelTrial(11) {}
  /// The platform's position, or one drive, which shall stand still where the errors say.
  TaskGoal goal_at(const test::Posture& at, int sort, const PlatformVector& sigma_d) const {
    const Task task =
        sort == 0 ? platform_position_task(*robot, at.kinematics) : drive_task(at.kinematics, 1);
    const int rows = task.rows();
    const PlatformVector zero = PlatformVector::Zero(rows);
    const TaskGains gains = sort == 0 ? TaskGains::uniform(rows, 0, 0, 0, 2000.0, 1.0)
                                      : TaskGains::uniform(rows, 0, 0, 0, 2500.0, 1.0);
    return {task, {sigma_d - task.sigma, zero, zero}, gains};
  }
  static PlatformMatrix inertia_of(const TaskGoal& goal, const test::Posture& at) {
    const PlatformMatrix J = goal.task.J;
    const PlatformMatrix mobility = J * at.dynamics.M_x.inverse() * J.transpose();
    return mobility.inverse();
  }
};

// M_i is what moves with the task where as little moves as can: no motion that moves it so has less kinetic
// energy.
TEST_F(TaskEnergyOf, IsThatOfASpringAndOfTheSlowestMotionThatMovesTheTaskSo) {
  for (int trial = 0; trial < 200; ++trial) {
    const test::Posture at = any_posture();
    const int sort = trial % 2;
    const TaskGoal goal = goal_at(at, sort, PlatformVector::Zero(2 - sort));
    const double spring = 0.5 * goal.gains.force[0] * goal.reference.error.squaredNorm();
    const double kinetic = energy_of(goal, at.kinematics, at.dynamics) - spring;
    const PlatformVector v = at.kinematics.velocity;
    const PlatformMatrix J = goal.task.J;
    const PlatformMatrix free =
        PlatformMatrix::Identity(3, 3) - J.transpose() * (J * J.transpose()).inverse() * J;
    double least = 1e9;
    PlatformVector slowest = v;
    for (int step = 0; step < 4000; ++step) {  // down the kinetic energy, along what leaves the task alone
      slowest -= 1.0 / at.dynamics.M_x.norm() * free * (at.dynamics.M_x * slowest);
      least = std::min(least, 0.5 * slowest.dot(at.dynamics.M_x * slowest));
    }
    EXPECT_LE(kinetic, 0.5 * v.dot(at.dynamics.M_x * v) + 1e-12);
    EXPECT_NEAR(kinetic, least, 1e-6 * std::max(1.0, least));
  }
}

// (48), by the robot's equations of motion: damping takes out, a change of the inertia and forces from
// outside add.
TEST_F(TaskEnergyOf, ChangesByDampingInertiaAndForcesAlone) {
  Residual residual("dV/dt against (48), relative", 1e-5);
  constexpr double h = 1e-5;  // [s]
  for (int trial = 0; trial < 300; ++trial) {
    const int sort = trial % 2;
    const test::Posture now = any_posture();
    const PlatformVector sigma = goal_at(now, sort, PlatformVector::Zero(2 - sort)).task.sigma;
    const PlatformVector goal_sigma = sigma + any(0.02, 0.02).head(2 - sort);
    const TaskGoal goal = goal_at(now, sort, goal_sigma);
    TaskList list;
    list.add(goal);
    const JointVector torque = task_torque(
        TaskLevel::torque, task_reference(TaskLevel::torque, list, now.kinematics, now.dynamics, settings),
        now.kinematics, now.dynamics, settings);
    const Eigen::Vector3d wrench = any(20.0, 2.0), pose = now.kinematics.pose, v = now.kinematics.velocity;
    const Eigen::Vector3d dv = *robot->acceleration(pose, v, Eigen::Vector3d(torque), wrench);
    const auto later = [&](double t) {
      return test::Posture(*robot, Eigen::Vector3d(pose + t * v + 0.5 * t * t * dv),
                           Eigen::Vector3d(v + t * dv));
    };
    const test::Posture before = later(-h), after = later(h);
    const TaskGoal goal_before = goal_at(before, sort, goal_sigma),
                   goal_after = goal_at(after, sort, goal_sigma);
    const double rate = (energy_of(goal_after, after.kinematics, after.dynamics) -
                         energy_of(goal_before, before.kinematics, before.dynamics)) /
                        (2.0 * h);

    const PlatformMatrix M = inertia_of(goal, now);
    const PlatformMatrix dM = (inertia_of(goal_after, after) - inertia_of(goal_before, before)) / (2.0 * h);
    const PlatformMatrix K = goal.gains.force.asDiagonal();
    const PlatformMatrix D = impedance_damping(M, K, goal.gains.damping_ratio).D;
    const PlatformVector de = -goal.task.rate(now.kinematics.velocity);
    const PlatformVector F = M * (goal.task.J * (now.dynamics.M_x.inverse() * PlatformVector(wrench)));
    const double damped = de.dot(D * de), expected = -damped + 0.5 * de.dot(dM * de) - de.dot(F);
    residual.add((rate - expected) / std::max(1.0, damped));
    EXPECT_GT(damped, 0.0);
  }
}

TEST_F(TaskEnergyOf, ATaskThatIsNotValidIsNoNumber) {
  const test::Posture at = any_posture();
  EXPECT_TRUE(std::isnan(energy_of({no_task(1, 3), {}, {}}, at.kinematics, at.dynamics)));
}

/// A watch over the platform's position and both constraints, of which none is active.
struct Watch {
  explicit Watch(const test::Posture& at, const TaskGoal& goal) {
    block = &builder.add<TaskEnergyMonitor>("energies");
    tasks = builder.export_input("tasks", block->tasks);
    kept = builder.export_input("kept", block->constraint_goals);
    state = builder.export_input("state", block->constraints);
    const auto kinematics = builder.export_input("kinematics", block->kinematics);
    const auto dynamics = builder.export_input("dynamics", block->dynamics);
    ticking.emplace(builder);
    ticking->set(kinematics, at.kinematics);
    ticking->set(dynamics, at.dynamics);
    list.add(goal);
    list.valid = true;
    both.add(goal);
    both.add(goal);
    both.valid = true;
    ticking->set(kept, both);
    ticking->set(state, ConstraintState());
  }
  const TaskEnergies& tick() {
    ticking->set(tasks, list);
    ticking->tick();
    return ticking->get(block->energies);
  }

  DiagramBuilder builder{"test", 1ms};
  TaskEnergyMonitor* block = nullptr;
  TaskList list, both;
  InputPort<TaskList> tasks, kept;
  InputPort<ConstraintState> state;
  std::optional<test::Ticking> ticking;
};

TEST_F(TaskEnergyOf, IsToldOfWhatIsServedAndOfNothingElse) {
  const test::Posture at = any_posture();
  const TaskGoal goal = goal_at(at, 0, PlatformVector::Zero(2));
  Watch watch(at, goal);
  TaskEnergies told = watch.tick();
  EXPECT_TRUE(told.serves(2));
  EXPECT_FALSE(told.serves(0) || told.serves(1) || told.serves(3));
  EXPECT_EQ(told.energy[2], energy_of(goal, at.kinematics, at.dynamics));
  ConstraintState kept;
  kept.sigma_sc.active = true;
  watch.ticking->set(watch.state, kept);
  told = watch.tick();
  EXPECT_TRUE(told.serves(1));
  EXPECT_FALSE(told.serves(0));
  watch.list.valid = false;
  EXPECT_FALSE(watch.tick().serves(2));
}

TEST_F(TaskEnergyOf, IsToldWithoutAllocating) {
  const test::Posture at = any_posture();
  Watch watch(at, goal_at(at, 0, PlatformVector::Zero(2)));
  watch.tick();
  const test::AllocationCounter counter;
  watch.tick();
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace flinch
