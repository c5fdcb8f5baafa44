#include "systems/laws/task_priority.h"

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "tests/support/allocations.h"
#include "tests/systems/robot/residual.h"

namespace flinch {
namespace {

using test::Residual;

PlatformMatrix random_matrix(int rows, int columns) { return PlatformMatrix::Random(rows, columns); }

/// Rows far enough from one another, that all of them can be served.
PlatformMatrix independent_rows(int n) {
  while (true) {
    const PlatformMatrix J = random_matrix(n, n);
    const Eigen::JacobiSVD<PlatformMatrix> svd(J);
    if (svd.singularValues()[n - 1] > 0.3) return J;
  }
}

TEST(DampedInverse, IsTheMoorePenroseInverseOfWhatCanBeMoved) {
  Residual residual("against the pseudo-inverse of a complete orthogonal decomposition", 1e-12);
  for (int trial = 0; trial < 300; ++trial) {
    const PlatformMatrix J = independent_rows(4).topRows(1 + trial % 4);
    residual.add(damped_inverse(J), PlatformMatrix(J.completeOrthogonalDecomposition().pseudoInverse()));
  }
}

TEST(DampedInverse, LeavesOutWhatCannotBeMoved) {
  PlatformMatrix J(3, 3);  // rank 1
  J << 1.0, 2.0, 0.0, -1.0, -2.0, 0.0, 2.0, 4.0, 0.0;
  const PlatformMatrix inverse = damped_inverse(J);
  const PlatformMatrix exact = J.completeOrthogonalDecomposition().pseudoInverse();
  EXPECT_LT((inverse - exact).norm(), 1e-12);
  EXPECT_TRUE(damped_inverse(PlatformMatrix::Zero(2, 3)).isZero(0.0));
}

TEST(DampedInverse, StaysBoundedAndContinuousWhereATaskFades) {
  double before = 0.0;
  double largest_step = 0.0;
  for (double s = 0.1; s > 1e-9; s *= 0.999) {
    const PlatformMatrix J = s * PlatformMatrix::Identity(1, 3);
    const double gain = damped_inverse(J)(0, 0);
    EXPECT_LE(gain, 50.0 + 1e-9);
    if (before > 0.0) largest_step = std::max(largest_step, std::abs(gain - before));
    before = gain;
  }
  EXPECT_LT(largest_step, 1.0);
  EXPECT_EQ(before, 0.0);
}

TEST(TaskPriority, TheNullSpaceMovesNoneOfTheTasks) {
  Residual moved("J_A,i N_i", 1e-12);
  Residual projector("N N - N", 1e-12);
  for (int trial = 0; trial < 300; ++trial) {
    const PlatformMatrix J = independent_rows(6);
    TaskPriority priority(6);
    for (int first = 0; first < 6; first += 2) {
      priority.add(J.middleRows(first, 2), PlatformVector::Random(2));
      moved.add((J.topRows(first + 2) * priority.null_space()).lpNorm<Eigen::Infinity>());
      const PlatformMatrix& N = priority.null_space();
      projector.add((N * N - N).lpNorm<Eigen::Infinity>());
    }
  }
}

TEST(TaskPriority, IndependentTasksAreAllServedExactly) {
  Residual residual("J_i u - target_i of three tasks", 1e-12);
  for (int trial = 0; trial < 300; ++trial) {
    const PlatformMatrix J = independent_rows(3);
    const PlatformVector target = PlatformVector::Random(3);
    TaskPriority priority(3);
    for (int i = 0; i < 3; ++i) priority.add(J.row(i), target.segment(i, 1));
    residual.add((J * priority.solution() - target).lpNorm<Eigen::Infinity>());
  }
}

TEST(TaskPriority, OfTasksThatContradictTheHigherOneIsServed) {
  Residual residual("J_1 u - target_1", 1e-12);
  for (int trial = 0; trial < 100; ++trial) {
    const PlatformMatrix J = independent_rows(3).topRows(2);
    const PlatformVector target = PlatformVector::Random(2);
    TaskPriority priority(3);
    priority.add(J, target);
    priority.add(J.row(0), PlatformVector::Constant(1, 7.0));
    priority.add(random_matrix(2, 3), PlatformVector::Random(2));
    residual.add((J * priority.solution() - target).lpNorm<Eigen::Infinity>());
  }
}

Eigen::MatrixXd moore_penrose(const Eigen::MatrixXd& J) {
  return J.completeOrthogonalDecomposition().pseudoInverse();
}

struct SomeTasks {
  std::vector<Eigen::MatrixXd> J;
  std::vector<Eigen::VectorXd> target;

  PlatformVector served(PriorityForm form) const {
    TaskPriority priority(static_cast<int>(J.front().cols()), {}, form);
    for (std::size_t i = 0; i < J.size(); ++i) priority.add(J[i], target[i]);
    return priority.solution();
  }
  /// J_i^+ target_i
  Eigen::VectorXd alone(std::size_t i) const { return moore_penrose(J[i]) * target[i]; }
  /// N = I - J_A^+ J_A of the first `count` tasks, (32c), (32d).
  Eigen::MatrixXd null_space(std::size_t count) const {
    const Eigen::Index n = J.front().cols();
    Eigen::MatrixXd J_A(0, n);
    for (std::size_t i = 0; i < count; ++i) {
      Eigen::MatrixXd longer(J_A.rows() + J[i].rows(), n);
      longer << J_A, J[i];
      J_A = longer;
    }
    const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
    return count == 0 ? I : Eigen::MatrixXd(I - moore_penrose(J_A) * J_A);
  }
};

/// Up to four tasks of one or two rows for six drives.
SomeTasks some_tasks(int count) {
  const PlatformMatrix rows = independent_rows(6);
  SomeTasks tasks;
  for (int i = 0, first = 0; i < count; ++i) {
    const int size = 1 + i % 2;
    tasks.J.emplace_back(rows.middleRows(first, size));
    tasks.target.emplace_back(Eigen::VectorXd::Random(size));
    first += size;
  }
  return tasks;
}

TEST(TaskPriority, ThePrintedFormIsTheSumOfThePaper) {
  Residual residual("u against (32a) written out", 1e-12);
  for (int trial = 0; trial < 300; ++trial) {
    const SomeTasks tasks = some_tasks(2 + trial % 3);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(6);
    for (std::size_t i = 0; i + 1 < tasks.J.size(); ++i) {
      sum += tasks.alone(i) + tasks.null_space(i + 1) * tasks.alone(i + 1);
    }
    residual.add((tasks.served(PriorityForm::printed) - sum).norm());
  }
}

TEST(TaskPriority, TheAugmentedFormAddsEachTaskOnceInTheNullSpaceOfThoseBeforeIt) {
  Residual residual("u against the sum of the projected tasks", 1e-12);
  for (int trial = 0; trial < 300; ++trial) {
    const SomeTasks tasks = some_tasks(2 + trial % 3);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(6);
    for (std::size_t i = 0; i < tasks.J.size(); ++i) sum += tasks.null_space(i) * tasks.alone(i);
    residual.add((tasks.served(PriorityForm::augmented) - sum).norm());
  }
}

TEST(TaskPriority, OfTwoTasksThePrintedFormIsTheAugmentedOne) {
  for (int trial = 0; trial < 50; ++trial) {
    const SomeTasks tasks = some_tasks(2);
    EXPECT_EQ(tasks.served(PriorityForm::printed), tasks.served(PriorityForm::augmented));
  }
}

TEST(TaskPriority, ASingleTaskIsServedAlikeByEveryForm) {
  const SomeTasks tasks = some_tasks(1);
  const PlatformVector served = tasks.served(PriorityForm::recursive);
  EXPECT_LT((served - tasks.served(PriorityForm::augmented)).norm(), 1e-14);
  EXPECT_LT((served - tasks.served(PriorityForm::printed)).norm(), 1e-14);
}

double error_of_first(const SomeTasks& tasks, PriorityForm form) {
  return (tasks.J[0] * tasks.served(form) - tasks.target[0]).norm();
}

// With three tasks the printed sum (32a) has the middle one twice, once unprojected: the first is lost.
TEST(TaskPriority, ThePrintedSumBreaksThePriorityThatTheOtherFormsKeep) {
  double printed = 0.0;
  double others = 0.0;
  for (int trial = 0; trial < 50; ++trial) {
    const SomeTasks tasks = some_tasks(3);
    printed = std::max(printed, error_of_first(tasks, PriorityForm::printed));
    for (const PriorityForm form : {PriorityForm::recursive, PriorityForm::augmented}) {
      others = std::max(others, error_of_first(tasks, form));
    }
  }
  EXPECT_GT(printed, 0.1);
  EXPECT_LT(others, 1e-12);
}

TEST(TaskPriority, WhatIsLeftFreeIsNeverCountedTwice) {
  for (const PriorityForm form : {PriorityForm::recursive, PriorityForm::augmented, PriorityForm::printed}) {
    const SomeTasks tasks = some_tasks(3);
    TaskPriority priority(6, {}, form);
    for (std::size_t i = 0; i < 3; ++i) priority.add(tasks.J[i], tasks.target[i]);
    const PlatformVector served = priority.solution();
    const PlatformVector wanted = PlatformVector::Random(6);
    const PlatformVector expected = priority.null_space() * wanted;
    priority.add_free(wanted);
    EXPECT_LT((priority.solution() - served - expected).norm(), 1e-12) << static_cast<int>(form);
  }
}

TEST(TaskPriority, MoreRowsThanDrivesAreNoHarm) {
  TaskPriority priority(3);
  for (int i = 0; i < 4; ++i) priority.add(random_matrix(2, 3), PlatformVector::Random(2));
  EXPECT_TRUE(priority.solution().allFinite());
  EXPECT_LT(priority.null_space().norm(), 1e-9);
}

TEST(TaskPriority, DoesNotAllocate) {
  const PlatformMatrix J = independent_rows(6);
  const PlatformVector target = PlatformVector::Random(2);
  for (const PriorityForm form : {PriorityForm::recursive, PriorityForm::augmented, PriorityForm::printed}) {
    const test::AllocationCounter counter;
    TaskPriority priority(6, {}, form);
    priority.add(J.topRows(2), target);
    priority.add(J.middleRows(2, 2), target);
    priority.add_free(PlatformVector::Zero(6));
    EXPECT_EQ(counter.count(), 0) << static_cast<int>(form);
    EXPECT_TRUE(priority.solution().allFinite());
  }
}

}  // namespace
}  // namespace flinch
