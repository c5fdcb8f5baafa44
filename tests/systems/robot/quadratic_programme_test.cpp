#include "systems/robot/quadratic_programme.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <optional>
#include <random>

#include "tests/support/allocations.h"

namespace flinch {
namespace {

using Status = ProgrammeSolution::Status;

/// Programmes of random size with random entries.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}

  double number() { return normal_(random_); }
  int count(int least, int most) { return std::uniform_int_distribution<int>(least, most)(random_); }
  bool chance(double share) { return std::bernoulli_distribution(share)(random_); }

  Eigen::MatrixXd matrix(int rows, int columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [this] { return number(); });
  }

  /// `feasible`: some point fulfils all constraints.
  QuadraticProgramme programme(int n, int rows, bool feasible) {
    QuadraticProgramme p;
    const Eigen::MatrixXd root = matrix(n, n);
    p.H = root.transpose() * root + 1e-3 * Eigen::MatrixXd::Identity(n, n);
    p.f = matrix(n, 1);
    p.C = matrix(rows, n);
    p.d = matrix(rows, 1);
    if (feasible) p.d = p.C * matrix(n, 1) - matrix(rows, 1).cwiseAbs();
    return p;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

/// By how much a solution misses the conditions of Karush, Kuhn and Tucker, which a minimum fulfils and
/// nothing else does; as a share of the numbers that come together.
double kkt_residual(const QuadraticProgramme& p, const ProgrammeSolution& s) {
  const Eigen::VectorXd pull = p.C.transpose() * s.multipliers;
  const double forces = 1.0 + (p.H * s.z).norm() + p.f.norm() + pull.norm();
  const double stationarity = (p.H * s.z + p.f - pull).norm() / forces;
  const Eigen::VectorXd room = p.C * s.z - p.d;
  const double lengths = 1.0 + s.z.norm() + p.d.norm();
  const double feasibility = std::max(0.0, -room.minCoeff()) / lengths;
  const double sign = std::max(0.0, -s.multipliers.minCoeff()) / forces;
  const double complementarity = s.multipliers.cwiseProduct(room).cwiseAbs().maxCoeff() / (forces * lengths);
  return std::max({stationarity, feasibility, sign, complementarity});
}

/// The minimum where the rows of `active` hold with equality; none where they depend on one another.
std::optional<Eigen::VectorXd> minimum_on(const QuadraticProgramme& p, const std::vector<int>& active) {
  const auto n = p.f.size(), m = static_cast<Eigen::Index>(active.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + m, n + m);
  Eigen::VectorXd right(n + m);
  system.topLeftCorner(n, n) = p.H;
  right.head(n) = -p.f;
  for (Eigen::Index i = 0; i < m; ++i) {
    const int row = active[static_cast<std::size_t>(i)];
    system.block(n + i, 0, 1, n) = p.C.row(row);
    system.block(0, n + i, n, 1) = p.C.row(row).transpose();
    right[n + i] = p.d[row];
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(system);
  if (!lu.isInvertible()) return std::nullopt;
  return lu.solve(right).head(n);
}

/// The minimum by trying every set of active constraints; none where no point is feasible.
std::optional<Eigen::VectorXd> minimum_by_trial(const QuadraticProgramme& p) {
  const int rows = static_cast<int>(p.d.size());
  std::optional<Eigen::VectorXd> best;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned set = 0; set < 1U << rows; ++set) {
    std::vector<int> active;
    for (int row = 0; row < rows; ++row) {
      if ((set >> row & 1U) != 0) active.push_back(row);
    }
    if (static_cast<Eigen::Index>(active.size()) > p.f.size()) continue;
    const auto z = minimum_on(p, active);
    if (!z || (p.C * *z - p.d).minCoeff() < -1e-9 * (1.0 + z->norm())) continue;
    const double value = 0.5 * z->dot(p.H * *z) + p.f.dot(*z);
    if (value < least) least = value, best = z;
  }
  return best;
}

TEST(QuadraticProgramme, FulfilsTheConditionsOfAMinimum) {
  Draw draw(1);
  double worst = 0.0;
  int most_steps = 0;
  for (int trial = 0; trial < 50000; ++trial) {
    const int n = draw.count(1, max_variables);
    const QuadraticProgramme p = draw.programme(n, draw.count(1, 40), true);
    const ProgrammeSolution s = solve(p);
    ASSERT_TRUE(s.solved()) << trial;
    worst = std::max(worst, kkt_residual(p, s));
    most_steps = std::max(most_steps, s.steps);
  }
  RecordProperty("kkt_residual", std::to_string(worst));
  RecordProperty("most_steps", most_steps);
  EXPECT_LT(worst, 1e-9);
}

TEST(QuadraticProgramme, FindsWhatTryingEveryActiveSetFinds) {
  Draw draw(2);
  int infeasible = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const int n = draw.count(1, 4);
    const QuadraticProgramme p = draw.programme(n, draw.count(1, 8), draw.chance(0.7));
    const auto expected = minimum_by_trial(p);
    const ProgrammeSolution s = solve(p);
    if (!expected) {
      EXPECT_EQ(s.status, Status::infeasible) << trial;
      ++infeasible;
    } else {
      ASSERT_TRUE(s.solved()) << trial;
      EXPECT_LT((s.z - *expected).norm(), 1e-7 * (1.0 + expected->norm())) << trial;
    }
  }
  EXPECT_GT(infeasible, 50);
}

TEST(QuadraticProgramme, BearsConstraintsThatDependOnOneAnother) {
  Draw draw(3);
  double worst = 0.0;
  for (int trial = 0; trial < 5000; ++trial) {
    const int n = draw.count(2, max_variables), rows = draw.count(2, 12);
    QuadraticProgramme p = draw.programme(n, 3 * rows, true);
    p.C.middleRows(rows, rows) = p.C.topRows(rows);  // each twice, and all through one point
    p.d.segment(rows, rows) = p.d.head(rows);
    const Eigen::VectorXd corner = draw.matrix(n, 1);
    p.d.tail(rows) = p.C.bottomRows(rows) * corner;
    p.d.head(rows) = p.C.topRows(rows) * corner;
    p.d.segment(rows, rows) = p.d.head(rows);
    p.C.row(0).setZero();
    p.d[0] = -1.0;
    const ProgrammeSolution s = solve(p);
    ASSERT_TRUE(s.solved()) << trial;
    worst = std::max(worst, kkt_residual(p, s));
  }
  EXPECT_LT(worst, 1e-8);
}

TEST(QuadraticProgramme, NeedsNoStepWhereNothingConstrains) {
  Draw draw(4);
  QuadraticProgramme p = draw.programme(4, 5, false);
  p.d.setConstant(-1e6);
  const ProgrammeSolution s = solve(p);
  EXPECT_EQ(s.steps, 0);
  EXPECT_LT((p.H * s.z + p.f).norm(), 1e-12);
}

TEST(QuadraticProgramme, SaysThatNoPointIsFeasible) {
  QuadraticProgramme p;
  p.H = Eigen::Matrix2d::Identity();
  p.f = Eigen::Vector2d::Zero();
  p.C = (Eigen::Matrix<double, 2, 2>() << 1.0, 0.0, -1.0, 0.0).finished();
  p.d = Eigen::Vector2d(1.0, 1.0);
  EXPECT_EQ(solve(p).status, Status::infeasible);
}

TEST(QuadraticProgramme, GivesUpAfterSoManySteps) {
  Draw draw(5);
  int gave_up = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const QuadraticProgramme p = draw.programme(7, 40, true);
    const ProgrammeSolution s = solve(p, 3);
    EXPECT_LE(s.steps, 3);
    EXPECT_TRUE(s.z.allFinite());
    if (s.status == Status::too_many_steps) ++gave_up;
  }
  EXPECT_GT(gave_up, 10);
}

TEST(QuadraticProgramme, RefusesWhatIsNone) {
  Draw draw(6);
  const QuadraticProgramme good = draw.programme(3, 4, true);
  for (int k = 0; k < 5; ++k) {
    QuadraticProgramme p = good;
    if (k == 0) p.H(1, 1) = -1.0;
    if (k == 1) p.f[0] = std::numeric_limits<double>::quiet_NaN();
    if (k == 2) p.d.resize(3);
    if (k == 3) p.C(2, 0) = std::numeric_limits<double>::infinity();
    if (k == 4) p.f.resize(2);
    EXPECT_EQ(solve(p).status, Status::refused) << k;
  }
}

TEST(QuadraticProgramme, NeverAllocates) {
  Draw draw(7);
  const QuadraticProgramme p = draw.programme(7, 40, true);
  const test::AllocationCounter counter;
  const ProgrammeSolution s = solve(p);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_TRUE(s.solved());
}

}  // namespace
}  // namespace flinch
