#include "systems/laws/task_level.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "systems/framework/random.h"
#include "systems/robot/forward_dynamics.h"
#include "systems/robot/impedance_damping.h"
#include "systems/robot/joint_space_dynamics.h"
#include "systems/robot/reaction_tasks.h"
#include "systems/signals/pose_guidance.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/systems/laws/task_level_trial.h"
#include "tests/systems/robot/residual.h"

namespace flinch {
namespace {

using test::Residual;

constexpr std::array levels{TaskLevel::velocity, TaskLevel::acceleration, TaskLevel::torque};

class TaskLevels : public test::TaskLevelTrial {
 protected:
  TaskLevels() : TaskLevelTrial(7) {}
  PlatformVector any(int rows, double bound) {
    PlatformVector v(rows);
    for (double& entry : v) entry = random.uniform(-bound, bound);
    return v;
  }
  TaskGoal goal_of(const Task& task, const TaskGains& gains) {
    const int rows = task.rows();
    return {task, {any(rows, 0.02), any(rows, 0.3), any(rows, 3.0)}, gains};
  }
  TaskGoal drive_goal(const test::Posture& at, int drive) {
    return goal_of(drive_task(at.kinematics, drive), TaskGains::uniform(1, 10, 1250, 50, 2500, 1));
  }
  /// How the platform accelerates under drive torques.
  Eigen::Vector3d acceleration(const test::Posture& at, const JointVector& torque) const {
    const Eigen::Vector3d pose = at.kinematics.pose;
    const Eigen::Vector3d velocity = at.kinematics.velocity;
    return *robot->acceleration(pose, velocity, Eigen::Vector3d(torque), Eigen::Vector3d::Zero());
  }
};

// The impedance law written out, [SafePR] (7).
TEST_F(TaskLevels, OnTheTorqueLevelThePoseAsOneTaskIsTheImpedanceLaw) {
  Residual residual("torque against the impedance law [Nm]", 1e-12);
  const PlatformVector stiffness = Eigen::Vector3d(2000.0, 2000.0, 85.0);
  const PlatformVector ratio = Eigen::Vector3d::Ones();
  for (int trial = 0; trial < 300; ++trial) {
    const test::Posture at = any_posture();
    TaskGains gains = TaskGains::uniform(3, 0, 0, 0, 0, 1);
    gains.force = stiffness;
    const TaskGoal goal = goal_of(platform_pose_task(*robot, at.kinematics), gains);
    TaskList list;
    list.add(goal);
    const PlatformVector F = task_reference(TaskLevel::torque, list, at.kinematics, at.dynamics, settings);
    const JointVector torque = task_torque(TaskLevel::torque, F, at.kinematics, at.dynamics, settings);

    const PlatformMatrix K = stiffness.asDiagonal();
    const PlatformMatrix D = impedance_damping(at.dynamics.M_x, K, ratio).D;
    const PlatformVector dx = at.kinematics.velocity;
    const PlatformVector F_a = at.dynamics.C_x * dx + at.dynamics.g_x + at.dynamics.F_fr_x +
                               at.dynamics.M_x * goal.reference.acceleration + K * goal.reference.error +
                               D * (goal.reference.rate - dx);
    const JointVector expected = at.kinematics.J_x_qa.transpose() * F_a;
    residual.add((torque - expected).lpNorm<Eigen::Infinity>() / std::max(1.0, expected.norm()));
  }
}

// By the robot's equations of motion: what each law asks for happens.
TEST_F(TaskLevels, IndependentTasksReachTheirAccelerations) {
  Residual residual("ddsigma against what is asked for, relative", 1e-10);
  for (int trial = 0; trial < 300; ++trial) {
    const test::Posture at = any_posture();
    const std::array goals{
        drive_goal(at, 0),
        goal_of(passive_joint_task(at.kinematics, 0), TaskGains::uniform(1, 10, 1250, 75, 1000, 1)),
        drive_goal(at, 2)};
    TaskList list;
    for (const TaskGoal& goal : goals) list.add(goal);
    const JointVector torque =
        task_torque(TaskLevel::acceleration,
                    task_reference(TaskLevel::acceleration, list, at.kinematics, at.dynamics, settings),
                    at.kinematics, at.dynamics, settings);
    const Eigen::Vector3d dv = acceleration(at, torque);
    for (const TaskGoal& goal : goals) {
      const double e = goal.reference.error[0];
      const double de = goal.reference.rate[0] - goal.task.rate(at.kinematics.velocity)[0];
      const double expected =
          goal.reference.acceleration[0] + goal.gains.stiffness[0] * e + goal.gains.damping[0] * de;
      const double reached = (goal.task.J * dv)[0] + goal.task.drift[0];
      residual.add((reached - expected) / std::max(1.0, std::abs(expected)));
    }
  }
}

// M_1 e'' + D e' + K e = F_ext of the first task: (45), which holds only with the drift that (44b) omits.
TEST_F(TaskLevels, OnTheTorqueLevelTheFirstTaskMovesAsItsImpedanceSays) {
  Residual residual("M_1 dde + D de + K e of the first task", 1e-9);
  for (int trial = 0; trial < 300; ++trial) {
    const test::Posture at = any_posture();
    const TaskGoal first =
        goal_of(platform_position_task(*robot, at.kinematics), TaskGains::uniform(2, 30, 2000, 50, 2000, 1));
    TaskList list;
    list.add(first);
    list.add(drive_goal(at, 1));
    const JointVector torque = task_torque(
        TaskLevel::torque, task_reference(TaskLevel::torque, list, at.kinematics, at.dynamics, settings),
        at.kinematics, at.dynamics, settings);
    const Eigen::Vector3d dv = acceleration(at, torque);
    const PlatformMatrix M = (first.task.J * at.dynamics.M_x.inverse() * first.task.J.transpose()).inverse();
    const PlatformMatrix K = first.gains.force.asDiagonal();
    const PlatformMatrix D = impedance_damping(M, K, first.gains.damping_ratio).D;
    const PlatformVector de = first.reference.rate - first.task.rate(at.kinematics.velocity);
    const PlatformVector dde = first.reference.acceleration - first.task.J * dv - first.task.drift;
    residual.add((M * dde + D * de + K * first.reference.error).norm());
  }
}

// (34)-(46) as the paper writes them, in the coordinates of the drives, in the recursive form.
TEST_F(TaskLevels, TheTorqueLevelIsThatOfTheDynamicallyConsistentFormulasOfThePaper) {
  Residual residual("torque against the formulas in drive coordinates, relative", 1e-9);
  for (int trial = 0; trial < 200; ++trial) {
    const test::Posture at = any_posture();
    const JointSpaceDynamics joints = joint_space_dynamics(at.kinematics, at.dynamics);
    const std::array goals{drive_goal(at, 0), drive_goal(at, 2)};
    TaskList list;
    for (const TaskGoal& goal : goals) list.add(goal);

    const PlatformMatrix M_inverse = joints.M_qa.inverse();
    const JointVector dq = at.kinematics.rates.active;
    JointVector tau = JointVector::Zero(3);
    PlatformMatrix N = PlatformMatrix::Identity(3, 3);
    const auto add = [&](const PlatformMatrix& J, const PlatformVector& a_ref) {
      const PlatformMatrix J_p = J * N.transpose();
      const PlatformMatrix M_p =
          (J_p * M_inverse * J_p.transpose()).completeOrthogonalDecomposition().pseudoInverse();
      tau += J_p.transpose() * M_p * (a_ref - J * M_inverse * tau);
      N -= J_p.transpose() * M_p * J_p * M_inverse;
    };
    for (const TaskGoal& goal : goals) {
      const DriveTask task = seen_by_drives(goal.task, at.kinematics);
      const double M_i = 1.0 / (task.J * M_inverse * task.J.transpose())(0, 0);
      const double K = goal.gains.force[0];
      const double F = K * goal.reference.error[0] +
                       2.0 * std::sqrt(M_i * K) * (goal.reference.rate[0] - (task.J * dq)[0]);
      add(task.J, PlatformVector::Constant(1, goal.reference.acceleration[0] - task.drift[0] + F / M_i));
    }
    // What is left is braked in the coordinates of the platform: ddx = -20 dx.
    add(at.kinematics.J_x_qa, -settings.free_damping * at.kinematics.velocity - at.kinematics.dJ_x_qa * dq);
    const JointVector expected = tau + joints.C_qa * dq + joints.g_qa + joints.tau_fr_qa;

    const JointVector torque = task_torque(
        TaskLevel::torque, task_reference(TaskLevel::torque, list, at.kinematics, at.dynamics, settings),
        at.kinematics, at.dynamics, settings);
    residual.add((torque - expected).norm() / std::max(1.0, expected.norm()));
  }
}

/// [SafePR] (32a), (33a) or (44a) over the drives, evaluated as printed: `inverse` is J_i^+ of the first two
/// and J_i^T of the last, `target` what it acts on, and N_i projects as (32c) or (43) says.
template <class Inverse, class NullSpace>
JointVector printed_sum(const std::vector<Eigen::MatrixXd>& J, const std::vector<Eigen::VectorXd>& target,
                        Inverse inverse, NullSpace null_space) {
  JointVector sum = JointVector::Zero(J.front().cols());
  Eigen::MatrixXd J_A(0, J.front().cols());
  for (std::size_t i = 0; i + 1 < J.size(); ++i) {
    Eigen::MatrixXd longer(J_A.rows() + J[i].rows(), J_A.cols());
    longer << J_A, J[i];
    J_A = longer;
    sum += inverse(J[i]) * target[i] + null_space(J_A) * (inverse(J[i + 1]) * target[i + 1]);
  }
  return sum;
}

class PrintedLaws : public TaskLevels {
 protected:
  PrintedLaws() {
    settings.priorities = PriorityForm::printed;
    settings.free_damping = 0.0;  // The papers leave free what no task wants.
  }

  /// What the paper's laws are made of, at a posture with two or three tasks.
  struct Case {
    test::Posture at;
    JointSpaceDynamics joints;
    JointVector dq;
    TaskList list;
    std::vector<DriveTask> tasks;

    Eigen::VectorXd b_qa() const {
      return Eigen::VectorXd(joints.C_qa * dq + joints.g_qa + joints.tau_fr_qa);
    }
    std::vector<Eigen::MatrixXd> jacobians() const {
      std::vector<Eigen::MatrixXd> all;
      for (const DriveTask& task : tasks) all.emplace_back(task.J);
      return all;
    }
    /// Of each task what `wanted` says of its goal and Jacobian.
    template <class Wanted>
    std::vector<Eigen::VectorXd> targets(Wanted wanted) const {
      std::vector<Eigen::VectorXd> all;
      for (std::size_t i = 0; i < tasks.size(); ++i) all.emplace_back(wanted(list.goals[i], tasks[i]));
      return all;
    }
    PlatformVector rate_error(const TaskGoal& goal, const DriveTask& task) const {
      return goal.reference.rate - task.J * dq;
    }
  };
  Case any_case(int count) {
    const test::Posture at = any_posture();
    Case found{at, joint_space_dynamics(at.kinematics, at.dynamics), at.kinematics.rates.active, {}, {}};
    const std::array goals{
        drive_goal(at, 0),
        goal_of(passive_joint_task(at.kinematics, 0), TaskGains::uniform(1, 10, 1250, 75, 1000, 1)),
        drive_goal(at, 2)};
    for (int i = 0; i < count; ++i) {
      found.list.add(goals[static_cast<std::size_t>(i)]);
      found.tasks.push_back(
          seen_by_drives(found.list.goals[static_cast<std::size_t>(i)].task, at.kinematics));
    }
    return found;
  }
  JointVector torque_of(TaskLevel level, const Case& made) const {
    const PlatformVector reference =
        task_reference(level, made.list, made.at.kinematics, made.at.dynamics, settings);
    return task_torque(level, reference, made.at.kinematics, made.at.dynamics, settings);
  }
  static Eigen::MatrixXd moore_penrose(const Eigen::MatrixXd& J) {
    return J.completeOrthogonalDecomposition().pseudoInverse();
  }
  static Eigen::MatrixXd null_space(const Eigen::MatrixXd& J_A) {
    return Eigen::MatrixXd::Identity(J_A.cols(), J_A.cols()) - moore_penrose(J_A) * J_A;  // (32c)
  }
  static double relative(const JointVector& found, const JointVector& expected) {
    return (found - expected).norm() / std::max(1.0, expected.norm());
  }
};

TEST_F(PrintedLaws, OnTheVelocityLevelAreThoseOf32) {
  Residual residual("torque against (32a)-(32e) written out, relative", 1e-12);
  for (int trial = 0; trial < 200; ++trial) {
    const Case made = any_case(2 + trial % 2);
    const auto rates = made.targets([](const TaskGoal& goal, const DriveTask&) {
      return goal.reference.rate + goal.gains.velocity.cwiseProduct(goal.reference.error);
    });
    const JointVector dq_ref = printed_sum(made.jacobians(), rates, moore_penrose, null_space);
    const JointVector expected =
        settings.velocity_feedforward * dq_ref + settings.velocity_gain * (dq_ref - made.dq) + made.b_qa();
    residual.add(relative(torque_of(TaskLevel::velocity, made), expected));
  }
}

TEST_F(PrintedLaws, OnTheAccelerationLevelAreThoseOf33) {
  Residual residual("torque against (33a)-(33c) written out, relative", 1e-12);
  for (int trial = 0; trial < 200; ++trial) {
    const Case made = any_case(2 + trial % 2);
    const auto accelerations =
        made.targets([&](const TaskGoal& goal, const DriveTask& task) -> PlatformVector {
          return goal.reference.acceleration + goal.gains.stiffness.cwiseProduct(goal.reference.error) +
                 goal.gains.damping.cwiseProduct(made.rate_error(goal, task)) - task.drift;
        });
    const JointVector ddq_ref = printed_sum(made.jacobians(), accelerations, moore_penrose, null_space);
    residual.add(
        relative(torque_of(TaskLevel::acceleration, made), made.joints.M_qa * ddq_ref + made.b_qa()));
  }
}

TEST_F(PrintedLaws, OnTheTorqueLevelAreThoseOf44) {
  Residual residual("torque against (44a)-(44c) written out, relative", 1e-12);
  for (int trial = 0; trial < 200; ++trial) {
    const Case made = any_case(2 + trial % 2);
    const Eigen::MatrixXd M_inverse = made.joints.M_qa.inverse();
    const auto forces = made.targets([&](const TaskGoal& goal, const DriveTask& task) -> PlatformVector {
      const double M_i = 1.0 / (task.J * M_inverse * task.J.transpose())(0, 0);                     // (36)
      const double D_F = 2.0 * goal.gains.damping_ratio[0] * std::sqrt(M_i * goal.gains.force[0]);  // (46)
      return M_i * goal.reference.acceleration + goal.gains.force[0] * goal.reference.error +
             D_F * made.rate_error(goal, task);
    });
    const auto transposed = [](const Eigen::MatrixXd& J) -> Eigen::MatrixXd { return J.transpose(); };
    const auto projector = [&](const Eigen::MatrixXd& J_A) -> Eigen::MatrixXd {
      const Eigen::MatrixXd M_A = (J_A * M_inverse * J_A.transpose()).inverse();  // (41)
      const Eigen::MatrixXd J_bar = M_inverse * J_A.transpose() * M_A;            // (42)
      return Eigen::MatrixXd::Identity(J_A.cols(), J_A.cols()) - J_A.transpose() * J_bar.transpose();
    };
    const JointVector tau_ref = printed_sum(made.jacobians(), forces, transposed, projector);
    residual.add(relative(torque_of(TaskLevel::torque, made), tau_ref + made.b_qa()));
  }
}

TEST_F(TaskLevels, OnTheVelocityLevelATaskMovesAtItsRate) {
  Residual residual("J dq_ref against dsigma_d + k e", 1e-12);
  for (int trial = 0; trial < 100; ++trial) {
    const test::Posture at = any_posture();
    const TaskGoal goal = drive_goal(at, 1);
    TaskList list;
    list.add(goal);
    const PlatformVector dq = task_reference(TaskLevel::velocity, list, at.kinematics, at.dynamics, settings);
    residual.add(dq[1] - goal.reference.rate[0] - 10.0 * goal.reference.error[0]);
    EXPECT_NEAR(dq[0], 0.0, 1e-12);  // what is free stands still
  }
}

TEST_F(TaskLevels, WithoutTasksTheRobotIsBraked) {
  for (const TaskLevel level : levels) {
    const test::Posture at = any_posture();
    const PlatformVector reference = task_reference(level, TaskList(), at.kinematics, at.dynamics, settings);
    const JointVector torque = task_torque(level, reference, at.kinematics, at.dynamics, settings);
    const Eigen::Vector3d dv = acceleration(at, torque);
    const Eigen::Vector3d v = at.kinematics.velocity;
    const Eigen::Vector3d p_rate = at.dynamics.M_x * dv;
    EXPECT_LT(p_rate.dot(v), 0.0) << static_cast<int>(level);
  }
}

TEST_F(TaskLevels, TasksThatAreNotValidArePassedOver) {
  for (const TaskLevel level : levels) {
    const test::Posture at = any_posture();
    TaskList one;
    one.add(drive_goal(at, 0));
    TaskList with_none = one;
    TaskGoal none = drive_goal(at, 1);
    none.task.valid = false;
    with_none.add(none);
    EXPECT_EQ(task_reference(level, one, at.kinematics, at.dynamics, settings),
              task_reference(level, with_none, at.kinematics, at.dynamics, settings));
  }
}

TEST_F(TaskLevels, WithoutKinematicsNothingIsAskedFor) {
  const test::Posture at = any_posture();
  for (const TaskLevel level : levels) {
    Kinematics nowhere;
    robot->kinematics(Configuration(), PlatformVector(), nowhere);
    EXPECT_TRUE(task_reference(level, TaskList(), nowhere, at.dynamics, settings).isZero(0.0));
  }
}

TEST_F(TaskLevels, NoLevelAllocates) {
  const test::Posture at = any_posture();
  TaskList list;
  list.add(
      goal_of(platform_position_task(*robot, at.kinematics), TaskGains::uniform(2, 30, 2000, 50, 2000, 1)));
  list.add(drive_goal(at, 0));
  for (const TaskLevel level : levels) {
    const test::AllocationCounter counter;
    const PlatformVector reference = task_reference(level, list, at.kinematics, at.dynamics, settings);
    const JointVector torque = task_torque(level, reference, at.kinematics, at.dynamics, settings);
    EXPECT_EQ(counter.count(), 0) << static_cast<int>(level);
    EXPECT_TRUE(torque.allFinite());
  }
}

TEST_F(TaskLevels, SaturationKeepsTheDirectionOfWhatIsAskedFor) {
  const Eigen::Vector3d known(10.0, -20.0, 0.0);
  const Eigen::Vector3d wanted(300.0, -40.0, 5.0);
  const JointVector torque = saturated(known, wanted, 100.0);
  EXPECT_DOUBLE_EQ(torque[0], 100.0);
  EXPECT_NEAR(((torque - known).normalized() - wanted.normalized()).norm(), 0.0, 1e-12);
  EXPECT_EQ(saturated(known, Eigen::Vector3d(1, 2, 3), 100.0), known + Eigen::Vector3d(1, 2, 3));
}

TEST_F(TaskLevels, SaturationStaysInsideWhereTheRobotsOwnDynamicsAloneIsTooMuch) {
  const JointVector torque =
      saturated(Eigen::Vector3d(150.0, 0.0, -120.0), Eigen::Vector3d(10.0, 10.0, 10.0), 100.0);
  EXPECT_LE(torque.lpNorm<Eigen::Infinity>(), 100.0);
}

TEST_F(TaskLevels, AFewNewtonsMoreNeverMakeTheSaturatedTorqueJump) {
  const Eigen::Vector3d known(80.0, -20.0, 0.0);
  JointVector before = saturated(known, Eigen::Vector3d(0, 0, 0), 100.0);
  for (int i = 1; i <= 1000; ++i) {
    const JointVector now = saturated(known, 0.3 * i * Eigen::Vector3d(1.0, -1.5, 0.4), 100.0);
    EXPECT_LT((now - before).norm(), 1.0);
    before = now;
  }
}

}  // namespace
}  // namespace flinch
