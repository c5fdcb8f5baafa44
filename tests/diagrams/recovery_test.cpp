#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/diagrams/contact_bench.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

using enum ReactionMode;
using test::Bench;
using test::BenchExperiment;
using test::encoder_noise;

/// A robot that stands at `pose` when the run begins.
BenchExperiment standing_at(const Eigen::Vector3d& pose) {
  BenchExperiment experiment;
  experiment.friction = BenchFriction::test_bench;
  experiment.station.encoder_noise = encoder_noise;
  experiment.station.pose = pose;
  return experiment;
}

const Eigen::Vector3d far_out(-0.361, 0.0, 0.0);  // 11 mm beyond the limit, and only beyond that one

TEST(Recovery, BringsARobotBackThatStandsOutsideAtTheStart) {
  Bench bench(standing_at(far_out));
  bench.run(400ms);
  EXPECT_EQ(bench.gate().phase, GatePhase::waiting);
  bench.reset();
  EXPECT_EQ(bench.gate().phase, GatePhase::recovering);
  bench.run(500ms);
  EXPECT_EQ(bench.state().mode, recover);
  EXPECT_LT((bench.pose() - far_out).norm(), 1e-3) << "it moves only by targets";

  bench.go_to(Eigen::Vector3d(-0.2, 0.0, 0.0));
  double fastest = 0.0, torque = 0.0;
  bench.run(5s, [&] {
    ASSERT_TRUE(bench.gate().passes());
    fastest = std::max(fastest, bench.velocity().head<2>().norm());
    if (bench.gate().phase == GatePhase::recovering)
      torque = std::max(torque, bench.torque().torque.lpNorm<Eigen::Infinity>());
  });
  EXPECT_EQ(bench.gate().phase, GatePhase::open);
  EXPECT_EQ(bench.state().mode, nominal);
  EXPECT_LT((bench.pose() - Eigen::Vector3d(-0.2, 0.0, 0.0)).norm(), 1e-3);
  EXPECT_LT(fastest, 0.06);
  EXPECT_LE(torque, 30.0);
}

TEST(Recovery, FollowsAFaultOnceItIsAcknowledged) {
  Bench bench(standing_at(Eigen::Vector3d(-0.33, 0.0, 0.0)));
  bench.run(400ms);
  ASSERT_EQ(bench.gate().phase, GatePhase::open);
  bench.go_to(Eigen::Vector3d(-0.38, 0.0, 0.0));
  bench.run(1s);
  EXPECT_EQ(bench.gate().phase, GatePhase::closed);
  EXPECT_EQ(bench.gate().fault, GateFault::workspace_radius);
  EXPECT_GT(bench.pose().head<2>().norm(), 0.35) << "it comes to rest outside";
  bench.reset();
  bench.go_to(Eigen::Vector3d(-0.3, 0.0, 0.0));
  bench.run(100ms);  // it was not yet recovering at the tick of the target
  EXPECT_EQ(bench.state().mode, recover);
  bench.go_to(Eigen::Vector3d(-0.3, 0.0, 0.0));
  bench.run(3s);
  EXPECT_EQ(bench.state().mode, nominal);
  EXPECT_LT((bench.pose() - Eigen::Vector3d(-0.3, 0.0, 0.0)).norm(), 1e-3);
}

TEST(Recovery, EndsWhereTheRobotGoesFurtherOut) {
  Bench bench(standing_at(far_out));
  bench.run(400ms);
  bench.reset();
  bench.run(100ms);
  bench.go_to(Eigen::Vector3d(-0.40, 0.0, 0.0));
  bench.run(2s);
  EXPECT_EQ(bench.gate().phase, GatePhase::closed);
  EXPECT_EQ(bench.gate().fault, GateFault::workspace_radius);
  EXPECT_EQ(bench.gate().reaction, GateReaction::controlled_stop);
  EXPECT_GT(bench.pose()[0], far_out[0] - 0.02 * 0.35 - 1e-3);
  bench.reset();  // and begins again from there
  EXPECT_EQ(bench.gate().phase, GatePhase::recovering);
}

TEST(Recovery, EndsWhereTheRobotIsTouched) {
  Bench bench(standing_at(far_out));
  bench.run(400ms);
  bench.reset();
  bench.run(100ms);
  bench.push(Eigen::Vector3d(0.0, 20.0, 0.0));
  bench.run(100ms);
  EXPECT_EQ(bench.gate().phase, GatePhase::closed);
  EXPECT_EQ(bench.gate().fault, GateFault::touched_in_recovery);
}

TEST(Recovery, EndsWithoutEncoders) {
  Bench bench(standing_at(far_out));
  bench.run(400ms);
  bench.reset();
  bench.run(100ms);
  bench.lose_encoders(true);
  bench.run(3ms);
  EXPECT_EQ(bench.gate().phase, GatePhase::closed);
  EXPECT_EQ(bench.gate().reaction, GateReaction::zero_torque_and_brake);
  bench.reset();
  bench.run(10ms);
  EXPECT_EQ(bench.gate().phase, GatePhase::closed) << "what is not known is not tolerated";
}

TEST(Recovery, LeadsAwayFromSeveralLimitsAtOnce) {
  Bench bench(standing_at(Eigen::Vector3d(0.38, 0.0, 0.0)));  // a leg is nearly stretched, too
  bench.run(400ms);
  EXPECT_EQ(bench.gate().faults,
            fault_bit(GateFault::type_1_singularity) | fault_bit(GateFault::workspace_radius));
  const test::AllocationCounter counter;
  bench.reset();
  bench.run(100ms);
  bench.go_to(Configuration(Eigen::Vector3d(0.2, 0.0, 0.0)));
  bench.run(5s);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_EQ(bench.state().mode, nominal);
  EXPECT_LT((bench.pose() - Eigen::Vector3d(0.2, 0.0, 0.0)).norm(), 1e-3);
}

TEST(Recovery, BringsBackAPlatformThatIsTurnedTooFar) {
  const double turned = 33.0 * std::numbers::pi / 180.0;
  Bench bench(standing_at(Eigen::Vector3d(0.0, 0.0, turned)));
  bench.run(400ms);
  EXPECT_EQ(bench.gate().phase, GatePhase::waiting);
  bench.reset();
  bench.run(100ms);
  ASSERT_EQ(bench.state().mode, recover);
  bench.go_to(Eigen::Vector3d(0.0, 0.0, 0.0));
  bench.run(6s);
  EXPECT_EQ(bench.state().mode, nominal);
  EXPECT_LT(bench.pose().norm(), 1e-3);
}

}  // namespace
}  // namespace flinch
