#include "systems/robot/impedance_damping.h"

#include <limits>

#include "tests/systems/robot/random_motion.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

double smallest_eigenvalue(const Eigen::Matrix3d& matrix) {
  return matrix.selfadjointView<Eigen::Lower>().eigenvalues()[0];
}

PlatformMatrix stiffness(double translation, double rotation) {
  return Eigen::Matrix3d(Eigen::Vector3d(translation, translation, rotation).asDiagonal());
}

class Damping : public BothGeometries {};
FLINCH_FOR_BOTH_GEOMETRIES(Damping);

TEST_P(Damping, FactorisationServesThePublishedStiffnessEverywhere) {
  const PlatformVector critical = PlatformVector::Ones(3);
  for (const auto& [pose, velocity] : random_motions(robot, 600, 3)) {
    const PlatformMatrix M = dynamics_at(pose, velocity).M_x;
    const ImpedanceDamping damping = impedance_damping(M, stiffness(2000.0, 85.0), critical);
    EXPECT_EQ(damping.design, DampingDesign::factorisation);
    EXPECT_GT(smallest_eigenvalue(damping.D), 0.0);
    EXPECT_LT((damping.D - damping.D.transpose()).lpNorm<Eigen::Infinity>(), 1e-12);
  }
}

TEST_P(Damping, FallsBackWhereTheFactorisationIsNotPositiveDefinite) {
  const PlatformMatrix K = stiffness(2000.0, 0.1);
  const PlatformVector critical = PlatformVector::Ones(3);
  int fallbacks = 0;
  for (const auto& [pose, velocity] : random_motions(robot, 600, 3, 0.35)) {
    const PlatformMatrix M = dynamics_at(pose, velocity).M_x;
    const double factorised = smallest_eigenvalue(factorisation_damping(M, K, critical));
    const ImpedanceDamping damping = impedance_damping(M, K, critical);
    EXPECT_EQ(damping.design == DampingDesign::factorisation, factorised > 0.0);
    EXPECT_GT(smallest_eigenvalue(damping.D), 0.0);
    if (factorised <= 0.0) ++fallbacks;
  }
  EXPECT_GT(fallbacks, 0);
}

TEST_P(Damping, ModalDesignDampsEveryModeByTheGivenRatio) {
  Residual residual("D inv(M) D = 4 xi^2 K, relative", 1e-13);
  const PlatformMatrix K = stiffness(2000.0, 0.1);
  const double xi = 0.7;
  for (const auto& [pose, velocity] : motions) {
    const Eigen::Matrix3d M = dynamics_at(pose, velocity).M_x;
    const Eigen::Matrix3d D = modal_damping(M, K, PlatformVector::Constant(3, xi));
    const Eigen::Matrix3d product = D * M.inverse() * D;
    residual.add((product - 4.0 * xi * xi * K).norm() / (4.0 * xi * xi * K.norm()));
  }
}

TEST_P(Damping, FactorisationUsesSymmetricSquareRoots) {
  Residual residual("D against roots by another route, relative", 1e-13);
  const Eigen::Matrix3d K = stiffness(2000.0, 85.0);
  const Eigen::Vector3d xi(1.0, 0.8, 0.6);
  for (const auto& [pose, velocity] : motions) {
    const Eigen::Matrix3d M = dynamics_at(pose, velocity).M_x;
    // Denman-Beavers iteration: Y -> sqrt(M), Z -> inverse of it.
    Eigen::Matrix3d Y = M;
    Eigen::Matrix3d Z = Eigen::Matrix3d::Identity();
    for (int i = 0; i < 30; ++i) {
      const Eigen::Matrix3d next = 0.5 * (Y + Z.inverse());
      Z = 0.5 * (Z + Y.inverse());
      Y = next;
    }
    const Eigen::Matrix3d root_K = K.diagonal().cwiseSqrt().asDiagonal();
    const Eigen::Matrix3d D = Y * xi.asDiagonal() * root_K + root_K * xi.asDiagonal() * Y;
    residual.add((factorisation_damping(M, K, xi) - D).norm() / D.norm());
  }
}

TEST(DampingOfDecoupledAxes, IsTheTextbookValue) {
  const PlatformMatrix M = Eigen::Matrix3d(Eigen::Vector3d(4.0, 9.0, 0.25).asDiagonal());
  const PlatformMatrix K = stiffness(100.0, 16.0);
  const Eigen::Matrix3d expected = Eigen::Vector3d(40.0, 60.0, 4.0).asDiagonal();
  EXPECT_LT((factorisation_damping(M, K, PlatformVector::Ones(3)) - expected).norm(), 1e-13);
  EXPECT_LT((modal_damping(M, K, PlatformVector::Ones(3)) - expected).norm(), 1e-13);
}

TEST(DampingOfDecoupledAxes, ServesSixDegreesOfFreedom) {
  const PlatformMatrix M = PlatformMatrix::Identity(6, 6) * 4.0;
  const PlatformMatrix K = PlatformMatrix::Identity(6, 6) * 25.0;
  const ImpedanceDamping damping = impedance_damping(M, K, PlatformVector::Ones(6));
  EXPECT_LT((damping.D - 20.0 * PlatformMatrix::Identity(6, 6)).norm(), 1e-13);
}

TEST(DampingWithoutSolution, IsNoneAndZero) {
  const PlatformMatrix identity = PlatformMatrix::Identity(3, 3);
  const PlatformVector ones = PlatformVector::Ones(3);
  PlatformMatrix bad = identity;
  bad(1, 1) = std::numeric_limits<double>::quiet_NaN();
  for (const ImpedanceDamping& damping :
       {impedance_damping(-identity, identity, ones), impedance_damping(identity, bad, ones),
        impedance_damping(bad, identity, ones),
        impedance_damping(identity, PlatformMatrix::Identity(2, 2), ones),
        impedance_damping(identity, identity, PlatformVector::Ones(2))}) {
    EXPECT_EQ(damping.design, DampingDesign::none);
    EXPECT_EQ(damping.D, Eigen::Matrix3d::Zero());
  }
}

TEST(DampingWithoutSolution, NoStiffnessNeedsNoDamping) {
  const ImpedanceDamping damping =
      impedance_damping(PlatformMatrix::Identity(3, 3), PlatformMatrix::Zero(3, 3), PlatformVector::Ones(3));
  EXPECT_NE(damping.design, DampingDesign::none);
  EXPECT_LT(damping.D.norm(), 1e-12);
}

}  // namespace
}  // namespace flinch::test
