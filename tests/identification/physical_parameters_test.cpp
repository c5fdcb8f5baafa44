#include "identification/physical_parameters.h"
#include "systems/robot/decompositions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "systems/config/robot_file.h"
#include "systems/framework/random.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/planar_rrr.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::unique_ptr<const DynamicParameters> parameters_of(const std::string& robot) {
  return DynamicParameters::of(*load_robot(test::shipped("robots/" + robot)));
}

VectorXd deviations(const DynamicParameters& parameters) {
  VectorXd deviation(static_cast<Eigen::Index>(parameters.list().size()));
  for (Eigen::Index j = 0; j < deviation.size(); ++j)
    deviation[j] = parameters.list()[static_cast<std::size_t>(j)].deviation;
  return deviation;
}

/// A random information in which parameters go together, scaled to what is believed.
MatrixXd random_information(const VectorXd& deviation, RandomGenerator& random) {
  const Eigen::Index n = deviation.size();
  MatrixXd A(n, n);
  for (double& a : A.reshaped()) a = random.normal();
  const VectorXd scale = (0.01 * deviation).cwiseInverse();
  return scale.asDiagonal() * (A * A.transpose() / static_cast<double>(n) + 0.1 * MatrixXd::Identity(n, n)) *
         scale.asDiagonal();
}

/// Values drawn about what is believed, far enough that no robot can have them.
VectorXd unphysical(const DynamicParameters& parameters, RandomGenerator& random) {
  const VectorXd believed = parameters.believed(), deviation = deviations(parameters);
  for (;;) {
    VectorXd values = believed;
    for (Eigen::Index j = 0; j < values.size(); ++j) values[j] += 0.8 * deviation[j] * random.normal();
    if (!is_physical(parameters, values)) return values;
  }
}

class RobotsOfAllKinds : public ::testing::TestWithParam<const char*> {};

TEST_P(RobotsOfAllKinds, ArePhysicalAsTheirFilesSay) {
  const auto parameters = parameters_of(GetParam());
  EXPECT_TRUE(is_physical(*parameters, parameters->believed()));
}

// First-order condition of a convex problem: no physical point is a descent from the solution.
TEST_P(RobotsOfAllKinds, AreBroughtBackToTheNearestThatCanExist) {
  const auto parameters = parameters_of(GetParam());
  const VectorXd believed = parameters->believed(), deviation = deviations(*parameters);
  RandomGenerator random(7);
  for (int trial = 0; trial < 5; ++trial) {
    const VectorXd values = unphysical(*parameters, random);
    const MatrixXd H = random_information(deviation, random);
    const VectorXd nearest = nearest_physical(*parameters, values, H);
    const auto distance = [&](const VectorXd& at) { return (at - values).dot(H * (at - values)); };
    EXPECT_TRUE(is_physical(*parameters, nearest));
    EXPECT_LT(distance(nearest), distance(believed));
    const VectorXd gradient = 2.0 * H * (nearest - values);
    int tried = 0;
    for (int i = 0; i < 3000 && tried < 300; ++i) {
      VectorXd other = nearest;
      for (Eigen::Index j = 0; j < other.size(); ++j) other[j] += 0.3 * deviation[j] * random.normal();
      if (!is_physical(*parameters, other)) continue;
      ++tried;
      EXPECT_GT(gradient.dot(other - nearest), -1e-4 * distance(nearest));
    }
    EXPECT_GT(gradient.dot(believed - nearest), -1e-4 * distance(nearest));
  }
}

TEST_P(RobotsOfAllKinds, StayWhereTheyArePhysical) {
  const auto parameters = parameters_of(GetParam());
  RandomGenerator random(3);
  const VectorXd deviation = deviations(*parameters);
  VectorXd values = parameters->believed() + 0.01 * deviation;
  ASSERT_TRUE(is_physical(*parameters, values));
  const VectorXd nearest = nearest_physical(*parameters, values, random_information(deviation, random));
  EXPECT_LT((nearest - values).cwiseQuotient(deviation).norm(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Files, RobotsOfAllKinds,
                         ::testing::Values("planar_3rrr.yaml", "five_bar.yaml", "hexapod_6ups.yaml"));

TEST(PhysicalPlatforms, KeepTheTriangleInequality) {
  const auto parameters = parameters_of("hexapod_6ups.yaml");
  VectorXd values = parameters->believed();
  const Eigen::Index zz = 24 + 6;
  ASSERT_EQ(parameters->list()[static_cast<std::size_t>(zz)].name, "platform.I_zz");
  values[zz] = 0.3;  // more than I_xx + I_yy, though all are positive
  EXPECT_FALSE(is_physical(*parameters, values));
  const VectorXd weight = deviations(*parameters).cwiseAbs2().cwiseInverse();
  const auto robot = parameters->with(nearest_physical(*parameters, values, weight.asDiagonal()));
  const Eigen::Matrix3d I = dynamic_cast<const Hexapod&>(*robot).parameters().platform.inertia;
  const Eigen::Vector3d of_axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(I).eigenvalues();
  EXPECT_LE(of_axes[2], of_axes[0] + of_axes[1] + 1e-6);
  EXPECT_GT(of_axes[0], 0.0);
  EXPECT_NEAR(I(0, 0) + I(1, 1), I(2, 2), 1e-3) << "on the boundary, since the data want to go beyond";
}

/// One parameter, believed to be what no robot can have.
class Impossible final : public DynamicParameters {
 public:
  Impossible() {
    list_.push_back({.name = "mass", .unit = "kg", .believed = -1.0, .deviation = 1.0, .least = -1e9});
  }
  std::shared_ptr<const ParallelRobot> with(const VectorXd&) const override { return nullptr; }
  std::vector<MatrixXd> must_be_definite(const VectorXd& values) const override {
    return {MatrixXd::Constant(1, 1, values[0])};
  }
};

TEST(PhysicalParameters, AreAskedOfTheRobotFileToo) {
  EXPECT_THAT(
      test::problems_of([] { nearest_physical(Impossible(), VectorXd::Ones(1), MatrixXd::Ones(1, 1)); }),
      ElementsAre(HasSubstr("correct the robot file")));
}

}  // namespace
}  // namespace flinch
