#include "systems/safety/recovery_monitor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/safety/fault_table.h"
#include "tests/support/planar_rig.h"

namespace flinch {
namespace {

const FaultLimits limits;

struct Place {
  explicit Place(double x, double phi = 0.0)
      : posture(*robot, Eigen::Vector3d(x, 0.0, phi), PlatformVector::Zero(3), Time{}) {}

  PlaceTick tick() const {
    return {*robot, limits.workspace, posture.motion, posture.platform, posture.measures};
  }
  std::shared_ptr<const PlanarRrr> robot = test::planar_rig();
  test::Posture posture;
};

bool tolerates(const RecoveryMonitor& watch, GateFault fault) {
  return (tolerable_faults(watch, 0.02) & fault_bit(fault)) != 0;
}

TEST(PlaceExcess, IsPositiveJustWhereTheFaultIsPresent) {
  const double beyond = 1e-9;
  const PlaceExcess out = place_excess(Place(0.35 * (1.1 + beyond)).tick());
  EXPECT_NEAR(out[2], 0.1, 1e-8);
  EXPECT_LT(place_excess(Place(0.0).tick())[2], 0.0);
  EXPECT_NEAR(place_excess(Place(0.0, -1.2 * limits.workspace.max_rotation).tick())[3], 0.2, 1e-9);

  Place place(0.0);
  place.posture.measures.det_B = -0.12;
  place.posture.measures.det_A = 0.15;
  place.posture.measures.sigma_sc = 0.04;
  place.posture.motion.position[1] = limits.workspace.min_active - 0.1;
  const PlaceExcess near = place_excess(place.tick());
  EXPECT_NEAR(near[0], 0.2, 1e-12);
  EXPECT_NEAR(near[1], 0.25, 1e-12);
  EXPECT_NEAR(near[4], 0.1 / (limits.workspace.max_active - limits.workspace.min_active), 1e-12);
  EXPECT_NEAR(near[5], 0.2, 1e-12);
}

TEST(PlaceExcess, IsThatOfTheWorseOfLegsThatAreTooNearOneAnotherOrThePlatform) {
  FaultLimits with_gap;
  with_gap.workspace.min_platform_gap = 0.005;
  const Place place(0.0);
  test::Posture posture = place.posture;
  const PlaceTick tick{*place.robot, with_gap.workspace, posture.motion, posture.platform, posture.measures};
  posture.measures.platform_gap = 0.004;
  EXPECT_NEAR(place_excess(tick)[5], 0.2, 1e-12);
  posture.measures.sigma_sc = 0.03;
  EXPECT_NEAR(place_excess(tick)[5], 0.4, 1e-12);
  posture.measures.platform_gap = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(place_excess(tick)[5], 0.4, 1e-12);
}

TEST(PlaceExcess, IsNotKnownWithoutAPose) {
  Place place(0.4);
  place.posture.platform.status = PlatformMotion::Status::implausible;
  place.posture.motion.valid = false;
  for (const double excess : place_excess(place.tick())) EXPECT_TRUE(std::isnan(excess));
}

TEST(RecoveryMonitor, ToleratesThatTheRobotComesNearerAndNotThatItGoesFurther) {
  RecoveryMonitor watch;
  const auto see = [&watch](double x, bool recovering) { advance(watch, Place(x).tick(), recovering); };
  see(0.50, false);
  EXPECT_TRUE(tolerates(watch, GateFault::workspace_radius)) << "where a recovery may begin";
  see(0.45, true);
  EXPECT_TRUE(tolerates(watch, GateFault::workspace_radius));
  see(0.40, true);
  EXPECT_TRUE(tolerates(watch, GateFault::workspace_radius));
  see(0.40 + 0.019 * 0.35, true);
  EXPECT_TRUE(tolerates(watch, GateFault::workspace_radius)) << "within the margin";
  see(0.40 + 0.021 * 0.35, true);
  EXPECT_FALSE(tolerates(watch, GateFault::workspace_radius));
  see(0.34, true);
  see(0.34, true);
  see(0.35 * 1.03, true);
  EXPECT_FALSE(tolerates(watch, GateFault::workspace_radius)) << "it had been inside";
  see(0.45, false);
  see(0.45, true);
  EXPECT_TRUE(tolerates(watch, GateFault::workspace_radius)) << "a new recovery";
}

TEST(RecoveryMonitor, ToleratesNothingThatItDoesNotKnow) {
  RecoveryMonitor watch;
  Place place(0.4);
  place.posture.measures.valid = false;
  advance(watch, place.tick(), false);
  EXPECT_FALSE(tolerates(watch, GateFault::type_2_singularity));
  EXPECT_TRUE(tolerates(watch, GateFault::workspace_radius));
}

TEST(RecoveryMonitor, ToleratesNoOtherSideOfASingularity) {
  RecoveryMonitor watch;
  Place place(0.0);
  for (const double det_A : {0.1, 1e-6}) {
    place.posture.measures.det_A = det_A;
    advance(watch, place.tick(), false);
    EXPECT_TRUE(tolerates(watch, GateFault::type_2_singularity)) << det_A;
  }
  for (const double det_A : {0.0, -0.1, -0.5}) {
    place.posture.measures.det_A = det_A;
    advance(watch, place.tick(), false);
    EXPECT_FALSE(tolerates(watch, GateFault::type_2_singularity)) << det_A;
  }
}

TEST(RecoveryMonitor, ToleratesNoOtherFaultThanThoseOfPlace) {
  RecoveryMonitor watch;
  advance(watch, Place(0.4).tick(), false);
  FaultMask place = 0;
  for (const GateFault fault : faults_of_place) place |= fault_bit(fault);
  EXPECT_EQ(tolerable_faults(watch, 0.02) & ~place, FaultMask{0});
}

}  // namespace
}  // namespace flinch
