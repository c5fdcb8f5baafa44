#include "systems/laws/wrench_reference.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "systems/robot/reaction_tasks.h"
#include "tests/systems/laws/task_level_trial.h"
#include "tests/systems/robot/residual.h"

namespace flinch {
namespace {

class WrenchReference : public test::TaskLevelTrial {
 protected:
  WrenchReference() : TaskLevelTrial(21) {}

  /// One or two drives, that shall be elsewhere.
  TaskList any_list(const test::Posture& at, int count) {
    TaskList list;
    for (int drive = 0; drive < count; ++drive) {
      const auto any = [&](double bound) -> PlatformVector {
        return PlatformVector::Constant(1, random.uniform(-bound, bound));
      };
      list.add({drive_task(at.kinematics, drive),
                {any(0.1), any(0.3), any(3.0)},
                TaskGains::uniform(1, 10, 1250, 50, 2500, 1)});
    }
    return list;
  }
};

/// The least wrench, in the metric of kinetic energy, that accelerates the tasks of `list` as F does.
Eigen::Vector3d least_wrench(const TaskList& list, const Eigen::Vector3d& F, const Eigen::Matrix3d& M) {
  Eigen::MatrixXd J(list.count, 3);
  for (int i = 0; i < list.count; ++i) J.row(i) = list.goals[static_cast<std::size_t>(i)].task.J;
  const Eigen::MatrixXd mobility = J * M.inverse() * J.transpose();
  return J.transpose() * mobility.inverse() * J * M.inverse() * F;
}

// Gauss: what is not least has more than what the constraints ask for.
TEST_F(WrenchReference, BesideConstraintsWhatIsFreeIsOnlyDamped) {
  test::Residual residual("what is added to the constraints' wrench [N, Nm]", 1e-9);
  int gained = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const test::Posture at = any_posture();
    const TaskList list = any_list(at, 1 + trial % 2);
    const Eigen::Matrix3d M = at.dynamics.M_x;
    const Eigen::Vector3d v = at.kinematics.velocity;
    const Eigen::Vector3d F = wrench_reference(list, true, at.kinematics, at.dynamics, settings);
    const Eigen::Vector3d added = F - least_wrench(list, F, M);
    EXPECT_LE(added.dot(v), 1e-9);
    const Eigen::Vector3d momentum = M * v;
    residual.add((added + settings.free_damping * (momentum - least_wrench(list, momentum, M))).norm());
    const Eigen::Vector3d unaware = wrench_reference(list, false, at.kinematics, at.dynamics, settings);
    EXPECT_LT((least_wrench(list, unaware, M) - least_wrench(list, F, M)).norm(), 1e-6 * (1.0 + F.norm()));
    gained += (unaware - least_wrench(list, unaware, M)).dot(v) > 0.0 ? 1 : 0;
  }
  EXPECT_GT(gained, 0) << "beside a task that was planned, the platform may be held against it";
}

TEST_F(WrenchReference, OfTasksAloneItIsThatOfTheLevel) {
  const test::Posture at = any_posture();
  const TaskList list = any_list(at, 2);
  EXPECT_EQ(wrench_reference(list, false, at.kinematics, at.dynamics, settings),
            task_reference(TaskLevel::torque, list, at.kinematics, at.dynamics, settings));
}

TEST_F(WrenchReference, AnErrorIsWhatTheReferenceIsAheadBy) {
  const test::Posture at = any_posture();
  const TaskGoal goal = any_list(at, 1).goals[0];
  const TaskError error = error_of(goal, at.kinematics.velocity);
  EXPECT_EQ(error.e, goal.reference.error);
  EXPECT_NEAR(error.de[0], goal.reference.rate[0] - at.kinematics.rates.active[0], 1e-12);
}

}  // namespace
}  // namespace flinch
