#include "systems/estimators/chain_observability.h"
#include "systems/robot/decompositions.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

// From the matrices of the chain, with a period of 1 ms, by singular values.
TEST(ChainObservability, IsTheConditionOfWhatThreeSamplesShow) {
  constexpr double T = 1e-3;
  const Eigen::Matrix3d A{{1.0, T, T * T / 2.0}, {0.0, 1.0, T}, {0.0, 0.0, 1.0}};
  const Eigen::RowVector3d C(1.0, 0.0, 0.0);
  Eigen::Matrix3d seen;
  seen << C, C * A, C * A * A;
  seen.colwise().normalize();
  const Eigen::Vector3d three = Eigen::JacobiSVD<Eigen::Matrix3d>(seen).singularValues();
  EXPECT_NEAR(chain_observability<3>(), three[2] / three[0], 1e-12);
  const Eigen::Vector2d two =
      Eigen::JacobiSVD<Eigen::Matrix<double, 3, 2>>(seen.leftCols<2>()).singularValues();
  EXPECT_NEAR(chain_observability<2>(), two[1] / two[0], 1e-12);
  EXPECT_GT(chain_observability<3>(), 0.0);
}

}  // namespace
}  // namespace flinch
