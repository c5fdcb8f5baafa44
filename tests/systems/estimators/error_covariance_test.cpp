#include "systems/estimators/error_covariance.h"
#include "systems/robot/decompositions.h"

#include <gtest/gtest.h>

#include "systems/framework/random.h"

namespace flinch {
namespace {

constexpr int states = 5, outputs = 3;

Eigen::MatrixXd random_matrix(RandomGenerator& random, int rows, int columns) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return random.normal(); });
}

// All at once: K = P C^T (C P C^T + R)^-1.
TEST(ErrorCovariance, TakesMeasurementsOneByOneAsAllAtOnce) {
  RandomGenerator random(4);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::MatrixXd root = random_matrix(random, states, states);
    const Eigen::MatrixXd P = root * root.transpose();
    const Eigen::MatrixXd C = random_matrix(random, outputs, states);
    const Eigen::VectorXd R = random_matrix(random, outputs, 1).cwiseAbs2(),
                          e = random_matrix(random, outputs, 1);
    const Eigen::MatrixXd S = C * P * C.transpose() + Eigen::MatrixXd(R.asDiagonal());
    const Eigen::MatrixXd K = P * C.transpose() * S.inverse();

    ErrorCovariance<8> errors;
    errors.P = P;
    errors.correction.setZero(states);
    double squares = 0.0;
    for (int i = 0; i < outputs; ++i) squares += errors.measure(C.row(i).transpose(), R[i], e[i]);
    EXPECT_LT((errors.correction - K * e).norm(), 1e-9 * (1.0 + e.norm()));
    EXPECT_LT((errors.P - (P - K * C * P)).norm(), 1e-9 * P.norm());
    EXPECT_NEAR(squares, e.dot(S.inverse() * e), 1e-8 * squares);
  }
}

TEST(ErrorCovariance, StaysPositiveUnderMeasurementsThatAreNearlyExact) {
  ErrorCovariance<4> errors;
  errors.P = Eigen::Matrix3d::Identity();
  errors.correction.setZero(3);
  RandomGenerator random(5);
  for (int k = 0; k < 1000; ++k) {
    errors.measure(random_matrix(random, 3, 1), 1e-10, 0.0);
    const Eigen::Matrix3d P = errors.P;
    ASSERT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(P).eigenvalues()[0], 0.0) << k;
  }
}

}  // namespace
}  // namespace flinch
