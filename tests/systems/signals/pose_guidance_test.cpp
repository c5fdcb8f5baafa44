#include "systems/signals/pose_guidance.h"

#include <gtest/gtest.h>

#include <random>

#include "systems/motion/chart_motion.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

/// A smooth motion on the manifold, quadratic in the chart at its start.
struct Course {
  ConfigurationSpace space;
  Configuration start;
  PlatformVector rate, bend;

  PlatformReference at(double t) const {
    return chart_motion(space, start, t * rate + 0.5 * t * t * bend, rate + t * bend, bend);
  }
};

class PoseGuidanceIn : public testing::TestWithParam<ConfigurationSpace::Kind> {
 protected:
  PlatformVector random(double size) {
    return PlatformVector::NullaryExpr(space_.dimension(), [&] { return size * normal_(generator_); });
  }
  Course course() { return {space_, space_.plus(space_.origin(), random(0.4)), random(0.8), random(2.0)}; }

  PoseGuidance guidance_at(const Course& desired, const Course& platform, double t) const {
    const PlatformReference now = platform.at(t);
    return guide(space_, desired.at(t), now.pose, now.velocity);
  }

  ConfigurationSpace space_ = GetParam();
  std::mt19937_64 generator_{1};
  std::normal_distribution<double> normal_;
};

constexpr double h = 1e-5;

TEST_P(PoseGuidanceIn, SaysHowItsOwnVelocityChanges) {
  for (int i = 0; i < 100; ++i) {
    const Course desired = course(), platform = course();
    const PlatformVector change =
        (guidance_at(desired, platform, h).velocity - guidance_at(desired, platform, -h).velocity) / (2 * h);
    ASSERT_LT((change - guidance_at(desired, platform, 0.0).acceleration).norm(), 1e-7);
  }
}

TEST_P(PoseGuidanceIn, LetsTheSpringTakeUpThePowerOfItsWrench) {
  const PlatformVector stiffness = random(30.0).cwiseAbs();
  const auto potential = [&](const Course& desired, const Course& platform, double t) {
    const PlatformVector e = guidance_at(desired, platform, t).error;
    return 0.5 * e.dot(stiffness.cwiseProduct(e));
  };
  for (int i = 0; i < 100; ++i) {
    const Course desired = course(), platform = course();
    const PoseGuidance now = guidance_at(desired, platform, 0.0);
    const PlatformVector wrench = spring_wrench(space_, now.error, stiffness.cwiseProduct(now.error));
    const double power = (now.velocity - platform.at(0.0).velocity).dot(wrench);
    const double change = (potential(desired, platform, h) - potential(desired, platform, -h)) / (2 * h);
    ASSERT_NEAR(change, power, 1e-6 * (1.0 + std::abs(power)));
  }
}

TEST_P(PoseGuidanceIn, IsTheReferenceItselfWhereThePlatformFollowsIt) {
  const Course desired = course();
  const PlatformReference now = desired.at(0.1);
  const PoseGuidance guidance = guide(space_, now, now.pose, now.velocity);
  EXPECT_LT(guidance.error.norm(), 1e-15);
  EXPECT_LT((guidance.velocity - now.velocity).norm(), 1e-15);
  EXPECT_LT((guidance.acceleration - now.acceleration).norm(), 1e-14);
}

TEST_P(PoseGuidanceIn, NeedsNoHeap) {
  const PlatformReference desired = course().at(0.1), platform = course().at(0.1);
  const test::AllocationCounter counter;
  const PoseGuidance guidance = guide(space_, desired, platform.pose, platform.velocity);
  const PlatformVector wrench = spring_wrench(space_, guidance.error, guidance.error);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_TRUE(wrench.allFinite());
}

INSTANTIATE_TEST_SUITE_P(EverySpace, PoseGuidanceIn,
                         testing::Values(ConfigurationSpace::Kind::plane, ConfigurationSpace::Kind::space,
                                         ConfigurationSpace::Kind::planar_pose,
                                         ConfigurationSpace::Kind::spatial_pose));

TEST(SpringWrench, IsTheGradientAlsoWhereStiffnessesDiffer) {
  PlatformVector error = PlatformVector::Zero(6), K_e = PlatformVector::Zero(6);
  error.tail<3>() = Eigen::Vector3d(0.2, -0.1, 0.3);
  K_e.tail<3>() = Eigen::Vector3d(90.0, 70.0, 60.0).cwiseProduct(Eigen::Vector3d(error.tail<3>()));
  const PlatformVector wrench = spring_wrench(ConfigurationSpace::Kind::spatial_pose, error, K_e);
  EXPECT_LT((wrench.tail<3>() - Eigen::Vector3d(17.801554, -7.899165, 17.832576)).norm(), 1e-6);
}

}  // namespace
}  // namespace flinch
