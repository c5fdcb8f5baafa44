#include "systems/robot/rotation.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>
#include <unsupported/Eigen/MatrixFunctions>

#include "tests/systems/robot/differences.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

constexpr double pi = std::numbers::pi;

// Rotation vectors of all lengths up to `longest`, those near 0 included.
std::vector<Eigen::Vector3d> rotation_vectors(double longest) {
  std::mt19937 generator(11);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> vectors;
  for (const double angle : {0.0, 1e-12, 1e-6, 9e-5, 1.1e-4, 9e-3, 1.1e-2, 0.1, 1.0, 2.0, 3.0, longest}) {
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d axis(normal(generator), normal(generator), normal(generator));
      vectors.push_back(angle * axis.normalized());
    }
  }
  return vectors;
}

// The exponential of S(xi), by scaling and squaring of its series.
Eigen::Matrix3d exponential(const Eigen::Vector3d& xi) { return cross_matrix(xi).exp(); }

// The angular velocity of a path of rotations, from R' R^T.
template <class Path>
Eigen::Vector3d angular_velocity(Path path, double step) {
  const Eigen::Matrix3d S = derivative(path, step) * path(0.0).transpose();
  return {S(2, 1), S(0, 2), S(1, 0)};
}

TEST(Rotation, MatrixOfTheQuaternionIsTheExponentialOfTheRotationVector) {
  Residual residual("Exp(xi) against the matrix exponential", 2e-15);
  for (const Eigen::Vector3d& xi : rotation_vectors(pi)) {
    residual.add(rotation_matrix(quaternion_exp(xi)), exponential(xi));
  }
}

TEST(Rotation, LogarithmUndoesTheExponential) {
  Residual residual("Log(Exp(xi)) [rad]", 1e-15);
  for (const Eigen::Vector3d& xi : rotation_vectors(pi - 1e-6)) {
    const Eigen::Vector4d q = quaternion_exp(xi);
    residual.add((quaternion_log(q) - xi).norm());
    residual.add((quaternion_log(-q) - xi).norm());
  }
}

TEST(Rotation, LogarithmIsAtMostHalfATurn) {
  EXPECT_NEAR(quaternion_log(quaternion_exp({0.0, 0.0, 4.0})).z(), 4.0 - 2.0 * pi, 1e-15);
  EXPECT_NEAR(quaternion_log(Eigen::Vector4d(0.0, 1.0, 0.0, 0.0)).norm(), pi, 1e-15);
  EXPECT_EQ(quaternion_log(Eigen::Vector4d(-1.0, 0.0, 0.0, 0.0)).norm(), 0.0);
}

TEST(Rotation, ProductOfQuaternionsIsThatOfTheirMatrices) {
  Residual residual("R(a b) = R(a) R(b)", 2e-15);
  const auto vectors = rotation_vectors(pi);
  for (std::size_t i = 1; i < vectors.size(); ++i) {
    const Eigen::Vector4d a = quaternion_exp(vectors[i]);
    const Eigen::Vector4d b = quaternion_exp(vectors[i - 1]);
    residual.add(rotation_matrix(quaternion_product(a, b)),
                 Eigen::Matrix3d(rotation_matrix(a) * rotation_matrix(b)));
  }
}

TEST(Rotation, LeftJacobianMapsTheRateOfTheVectorToTheAngularVelocity) {
  Residual residual("J_l(xi) against differences of Exp(xi)", 1e-10);
  Residual inverse("inverse of J_l", 2e-14);
  Residual right("J_l(-xi) is the transpose", 1e-15);
  const Eigen::Vector3d rate(0.5, -0.4, 0.6);
  for (const Eigen::Vector3d& xi : rotation_vectors(pi - 1e-3)) {
    const auto path = [&](double h) -> Eigen::Matrix3d { return exponential(xi + h * rate); };
    residual.add((left_jacobian(xi) * rate - angular_velocity(path, 1e-3)).norm());
    inverse.add(Eigen::Matrix3d(inverse_left_jacobian(xi) * left_jacobian(xi)),
                Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
    right.add(left_jacobian(-xi), Eigen::Matrix3d(left_jacobian(xi).transpose()));
  }
}

TEST(Rotation, RateOfTheLeftJacobianIsItsDerivative) {
  Residual residual("dJ_l/dt rate against differences", 1e-10);
  const Eigen::Vector3d rate(0.5, -0.4, 0.6);
  for (const Eigen::Vector3d& xi : rotation_vectors(pi - 1e-3)) {
    const auto omega = [&](double h) -> Eigen::Vector3d { return left_jacobian(xi + h * rate) * rate; };
    residual.add((left_jacobian_rate_times(xi, rate) - derivative(omega, 1e-3)).norm());
  }
}

// The gradient of k |xi|^2 / 2 turns xi into itself; an example with an uneven stiffness is worked out.
TEST(Rotation, RightJacobianGivesTheMomentOfARotationalSpring) {
  const Eigen::Vector3d e(0.2, -0.1, 0.3);
  const Eigen::Matrix3d J_r_inverse = inverse_left_jacobian(-e);
  EXPECT_LT((J_r_inverse.transpose() * e - e).norm(), 1e-15);
  const Eigen::Vector3d moment = J_r_inverse.transpose() * Eigen::Vector3d(90.0 * 0.2, -7.0, 18.0);
  EXPECT_LT((moment - Eigen::Vector3d(17.801554, -7.899165, 17.832576)).norm(), 1e-6) << moment.transpose();
}

}  // namespace
}  // namespace flinch::test
