#include "experiments/simulated/true_measures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/framework/diagram_builder.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

struct Meter {
  void see(const Configuration& pose, PlatformMotion::Status status = PlatformMotion::Status::valid) {
    ticking.set(platform, {ticking.now(), status, pose, PlatformVector::Zero(3)});
    ticking.tick();
  }
  const WorkspaceMeasures& measured() const { return ticking.get(block.measures); }

  DiagramBuilder builder{"test", 1ms};
  TrueMeasures& block = builder.add<TrueMeasures>("true_measures", test::planar_rig());
  InputPort<PlatformMotion> platform = builder.export_input("platform", block.platform);
  test::Ticking ticking{builder};
};

// Equal legs at home: links of neighbouring legs are nearest at two coupling joints, sqrt(3) r_c apart.
TEST(TrueMeasures, AreThoseOfTheTruePose) {
  Meter meter;
  meter.see(Eigen::Vector3d(0.05, 0.02, 0.1));
  EXPECT_TRUE(meter.measured().valid);
  Kinematics now;
  test::planar_rig()->kinematics(Eigen::Vector3d(0.05, 0.02, 0.1), PlatformVector::Zero(3), now);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(now.J_x_qa));
  EXPECT_NEAR(meter.measured().sigma_kappa, svd.singularValues()[0] / svd.singularValues()[2], 1e-9);
  EXPECT_NEAR(meter.measured().sigma_sc, std::sqrt(3.0) * 0.107, 1e-9);
}

TEST(TrueMeasures, OfARobotThatHasComeApartThereAreNone) {
  Meter meter;
  meter.see(Eigen::Vector3d(0.05, 0.02, 0.1), PlatformMotion::Status::no_data);
  EXPECT_FALSE(meter.measured().valid);
  meter.see(Eigen::Vector3d(5.0, 0.0, 0.0));
  EXPECT_FALSE(meter.measured().valid);
  meter.see(Eigen::Vector3d(std::nan(""), 0.0, 0.0));
  EXPECT_FALSE(meter.measured().valid);
}

TEST(TrueMeasures, NeverAllocate) {
  Meter meter;
  meter.see(Eigen::Vector3d(0.05, 0.02, 0.1));
  const test::AllocationCounter allocations;
  for (int k = 0; k < 10; ++k) meter.ticking.tick();
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace flinch
