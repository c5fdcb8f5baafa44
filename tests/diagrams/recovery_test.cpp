#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/diagrams/contact_rig.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

using enum ReactionMode;
using test::Bench;
using test::encoder_noise;
using test::RigExperiment;

/// A robot that stands at `pose` when the run begins.
RigExperiment standing_at(const Eigen::Vector3d& pose) {
  RigExperiment experiment;
  experiment.friction = RigFriction::test_rig;
  experiment.station.encoder_noise = encoder_noise;
  experiment.station.pose = pose;
  return experiment;
}

const Eigen::Vector3d far_out(-0.361, 0.0, 0.0);  // 11 mm beyond the limit, and only beyond that one

TEST(Recovery, BringsARobotBackThatStandsOutsideAtTheStart) {
  Bench rig(standing_at(far_out));
  rig.run(400ms);
  EXPECT_EQ(rig.gate().phase, GatePhase::waiting);
  rig.reset();
  EXPECT_EQ(rig.gate().phase, GatePhase::recovering);
  rig.run(500ms);
  EXPECT_EQ(rig.state().mode, recover);
  EXPECT_LT((rig.pose() - far_out).norm(), 1e-3) << "it moves only by targets";

  rig.go_to(Eigen::Vector3d(-0.2, 0.0, 0.0));
  double fastest = 0.0, torque = 0.0;
  rig.run(5s, [&] {
    ASSERT_TRUE(rig.gate().passes());
    fastest = std::max(fastest, rig.velocity().head<2>().norm());
    if (rig.gate().phase == GatePhase::recovering)
      torque = std::max(torque, rig.torque().torque.lpNorm<Eigen::Infinity>());
  });
  EXPECT_EQ(rig.gate().phase, GatePhase::open);
  EXPECT_EQ(rig.state().mode, nominal);
  EXPECT_LT((rig.pose() - Eigen::Vector3d(-0.2, 0.0, 0.0)).norm(), 1e-3);
  EXPECT_LT(fastest, 0.06);
  EXPECT_LE(torque, 30.0);
}

TEST(Recovery, FollowsAFaultOnceItIsAcknowledged) {
  Bench rig(standing_at(Eigen::Vector3d(-0.33, 0.0, 0.0)));
  rig.run(400ms);
  ASSERT_EQ(rig.gate().phase, GatePhase::open);
  rig.go_to(Eigen::Vector3d(-0.38, 0.0, 0.0));
  rig.run(1s);
  EXPECT_EQ(rig.gate().phase, GatePhase::closed);
  EXPECT_EQ(rig.gate().fault, GateFault::workspace_radius);
  EXPECT_GT(rig.pose().head<2>().norm(), 0.35) << "it comes to rest outside";
  rig.reset();
  rig.go_to(Eigen::Vector3d(-0.3, 0.0, 0.0));
  rig.run(100ms);  // it was not yet recovering at the tick of the target
  EXPECT_EQ(rig.state().mode, recover);
  rig.go_to(Eigen::Vector3d(-0.3, 0.0, 0.0));
  rig.run(3s);
  EXPECT_EQ(rig.state().mode, nominal);
  EXPECT_LT((rig.pose() - Eigen::Vector3d(-0.3, 0.0, 0.0)).norm(), 1e-3);
}

TEST(Recovery, EndsWhereTheRobotGoesFurtherOut) {
  Bench rig(standing_at(far_out));
  rig.run(400ms);
  rig.reset();
  rig.run(100ms);
  rig.go_to(Eigen::Vector3d(-0.40, 0.0, 0.0));
  rig.run(2s);
  EXPECT_EQ(rig.gate().phase, GatePhase::closed);
  EXPECT_EQ(rig.gate().fault, GateFault::workspace_radius);
  EXPECT_EQ(rig.gate().reaction, GateReaction::controlled_stop);
  EXPECT_GT(rig.pose()[0], far_out[0] - 0.02 * 0.35 - 1e-3);
  rig.reset();  // and begins again from there
  EXPECT_EQ(rig.gate().phase, GatePhase::recovering);
}

TEST(Recovery, EndsWhereTheRobotIsTouched) {
  Bench rig(standing_at(far_out));
  rig.run(400ms);
  rig.reset();
  rig.run(100ms);
  rig.push(Eigen::Vector3d(0.0, 20.0, 0.0));
  rig.run(100ms);
  EXPECT_EQ(rig.gate().phase, GatePhase::closed);
  EXPECT_EQ(rig.gate().fault, GateFault::touched_in_recovery);
}

TEST(Recovery, EndsWithoutEncoders) {
  Bench rig(standing_at(far_out));
  rig.run(400ms);
  rig.reset();
  rig.run(100ms);
  rig.lose_encoders(true);
  rig.run(3ms);
  EXPECT_EQ(rig.gate().phase, GatePhase::closed);
  EXPECT_EQ(rig.gate().reaction, GateReaction::zero_torque_and_brake);
  rig.reset();
  rig.run(10ms);
  EXPECT_EQ(rig.gate().phase, GatePhase::closed) << "what is not known is not tolerated";
}

TEST(Recovery, LeadsAwayFromSeveralLimitsAtOnce) {
  Bench rig(standing_at(Eigen::Vector3d(0.38, 0.0, 0.0)));  // a leg is nearly stretched, too
  rig.run(400ms);
  EXPECT_EQ(rig.gate().faults,
            fault_bit(GateFault::type_1_singularity) | fault_bit(GateFault::workspace_radius));
  const test::AllocationCounter counter;
  rig.reset();
  rig.run(100ms);
  rig.go_to(Configuration(Eigen::Vector3d(0.2, 0.0, 0.0)));
  rig.run(5s);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_EQ(rig.state().mode, nominal);
  EXPECT_LT((rig.pose() - Eigen::Vector3d(0.2, 0.0, 0.0)).norm(), 1e-3);
}

TEST(Recovery, BringsBackAPlatformThatIsTurnedTooFar) {
  const double turned = 33.0 * std::numbers::pi / 180.0;
  Bench rig(standing_at(Eigen::Vector3d(0.0, 0.0, turned)));
  rig.run(400ms);
  EXPECT_EQ(rig.gate().phase, GatePhase::waiting);
  rig.reset();
  rig.run(100ms);
  ASSERT_EQ(rig.state().mode, recover);
  rig.go_to(Eigen::Vector3d(0.0, 0.0, 0.0));
  rig.run(6s);
  EXPECT_EQ(rig.state().mode, nominal);
  EXPECT_LT(rig.pose().norm(), 1e-3);
}

}  // namespace
}  // namespace flinch
