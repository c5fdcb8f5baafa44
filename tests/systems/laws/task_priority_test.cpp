#include "systems/laws/task_priority.h"

#include <Eigen/Dense>

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

// With three tasks the printed sum (32a) has the middle one twice, once unprojected: the first is lost.
TEST(TaskPriority, ThePrintedSumBreaksThePriorityThatTheRecursiveFormKeeps) {
  double printed_error = 0.0;
  for (int trial = 0; trial < 50; ++trial) {
    const PlatformMatrix J = independent_rows(3);
    const PlatformVector target = PlatformVector::Random(3);
    const auto inverse = [&](int i) { return damped_inverse(J.row(i)); };
    PlatformVector printed = PlatformVector::Zero(3);
    TaskPriority so_far(3);
    for (int i = 0; i < 2; ++i) {
      so_far.add(J.row(i), target.segment(i, 1));
      printed += inverse(i) * target[i] + so_far.null_space() * inverse(i + 1) * target[i + 1];
    }
    printed_error = std::max(printed_error, std::abs((J.row(0) * printed)[0] - target[0]));
  }
  EXPECT_GT(printed_error, 0.1);
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
  const test::AllocationCounter counter;
  TaskPriority priority(6);
  priority.add(J.topRows(2), target);
  priority.add(J.bottomRows(2), target);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_TRUE(priority.solution().allFinite());
}

}  // namespace
}  // namespace flinch
