#include "diagrams/contact_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/diagrams/contact_rig.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

using enum ReactionMode;
using test::Bench;
using test::collision;
using test::encoder_noise;
using test::RigExperiment;

// ---------------------------------------------------------------- start

TEST(ContactControl, IsOneNestedDiagram) {
  Bench rig(RigExperiment{});
  EXPECT_EQ(rig.control.torque_command.id.owner->name(), "control");
  EXPECT_NO_THROW(rig.diagram->tap("control/torque_gate/status"));
  EXPECT_NO_THROW(rig.diagram->tap("control/wrench_estimate"));
}

TEST(ContactControl, KeepsTheBrakesClosedUntilContactsCanBeDetected) {
  Bench rig(RigExperiment{});
  rig.run(251ms, [&rig] {
    ASSERT_EQ(rig.gate().phase, GatePhase::waiting);
    ASSERT_FALSE(rig.torque().valid);
    ASSERT_TRUE(rig.context.get(rig.control.brake).engage);
  });
  rig.tick();
  EXPECT_EQ(rig.gate().phase, GatePhase::open);
  rig.tick();
  EXPECT_EQ(rig.state().mode, nominal);
  EXPECT_TRUE(rig.torque().valid);
  EXPECT_FALSE(rig.context.get(rig.control.brake).engage);
}

TEST(ContactControl, HoldsTheRobotWhereItFindsIt) {
  RigExperiment experiment;
  experiment.friction = RigFriction::test_rig;
  experiment.station.encoder_noise = encoder_noise;
  experiment.station.pose = Eigen::Vector3d(0.04, -0.06, 0.1);
  Bench rig(experiment);
  rig.run(3s, [&] { ASSERT_LT((rig.pose() - experiment.station.pose).norm(), 1e-4); });
  EXPECT_EQ(rig.state().mode, nominal);
  EXPECT_LT(rig.velocity().norm(), 1e-2);
}

// ---------------------------------------------------------------- without contact

TEST(ContactControl, FollowsTheSquareAndFeelsNothing) {
  RigExperiment experiment;
  experiment.friction = RigFriction::test_rig;
  experiment.station.encoder_noise = encoder_noise;
  experiment.station.pose = Eigen::Vector3d(-0.1, -0.1, 0.0);
  experiment.control.drive_torque.torque_constant = experiment.station.torque_constant;
  const PlanarRrr robot(rig_robot(RigGeometry::individual, experiment.friction));
  const PoseLimits limits{.translation = {1.5, 12.0, 2000.0}, .rotation = {4.0, 80.0, 8000.0}};
  experiment.control.trajectory.path = PlatformPath::square(robot, PlatformVector::Zero(3), 0.2, limits, 2);
  Bench rig(experiment);
  double error = 0.0, force = 0.0, moment = 0.0, speed = 0.0;
  rig.run(4s, [&] {
    const PlatformReference& reference = rig.context.get(rig.control.reference);
    if (!reference.valid) return;
    const PlatformVector& wrench = rig.context.get(rig.control.wrench_estimate).wrench_in_base;
    error = std::max(error, (reference.pose.head(2) - rig.pose().head(2)).norm());
    force = std::max(force, wrench.head(2).lpNorm<Eigen::Infinity>());
    moment = std::max(moment, std::abs(wrench[2]));
    speed = std::max(speed, rig.velocity().head(2).norm());
    ASSERT_EQ(rig.state().mode, nominal);
  });
  RecordProperty("position_error_mm", std::to_string(1e3 * error));
  RecordProperty("force_N", std::to_string(force));
  EXPECT_GT(speed, 1.3);
  EXPECT_LT(error, 0.010);  // [SafePR] V-B
  EXPECT_LT(force, 5.0);
  EXPECT_LT(moment, 0.3);
  EXPECT_TRUE(rig.context.get(rig.control.reference).finished);
}

// y = a y + (1 - a) k_t i with a = (2 - w T) / (2 + w T), from currents that are read again here.
TEST(ContactControl, AlignsTheTorqueWithWhateverFilterTheVelocityHas) {
  for (const double cutoff : {30.0, 60.0}) {
    for (const bool aligned : {true, false}) {
      RigExperiment experiment = collision(0.5);
      experiment.control.velocity_filter.low_pass.cutoff_frequency = cutoff;  // [Hz]
      experiment.control.aligned_with_velocity = aligned;
      Bench rig(experiment);
      rig.run(300ms);
      const double wT = 2.0 * std::numbers::pi * cutoff * 1e-3;
      const double a = aligned ? (2.0 - wT) / (2.0 + wT) : 0.0;
      JointVector expected = rig.context.get(rig.control.drive_torque).torque;
      double largest = 0.0;  // [Nm]
      rig.run(300ms, [&] {
        const JointVector held = 6.1 * rig.context.get(rig.station.drives).current;
        expected = a * expected + (1.0 - a) * held;
        largest = std::max(largest, (held - expected).norm());
        ASSERT_LT((rig.context.get(rig.control.drive_torque).torque - expected).norm(), 1e-12);
      });
      EXPECT_EQ(largest > 1.0, aligned) << "the filter has something to do";
    }
  }
}

TEST(ContactControl, GivesWayToAWeakForceByForceOverStiffness) {
  Bench rig(RigExperiment{});
  rig.run(300ms);
  rig.push(Eigen::Vector3d(8.0, -5.0, 0.5));
  rig.run(2s);
  EXPECT_EQ(rig.state().mode, nominal);
  EXPECT_LT((rig.pose() - Eigen::Vector3d(8.0 / 2000.0, -5.0 / 2000.0, 0.5 / 85.0)).norm(), 1e-5);
  EXPECT_LT((rig.context.get(rig.control.wrench_estimate).wrench_in_base -
             PlatformVector(Eigen::Vector3d(8, -5, 0.5)))
                .norm(),
            0.05);
}

// ---------------------------------------------------------------- reactions

class CollisionAtSpeed : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(ContactControl, CollisionAtSpeed, testing::Values(0.2, 0.5, 0.7));

TEST_P(CollisionAtSpeed, IsDetectedAndTheRobotRetreats) {
  Bench rig(collision(GetParam()));
  ASSERT_TRUE(rig.run_until(react, 2s));
  const Time detected = rig.context.get(rig.control.detection).detected;
  EXPECT_EQ(rig.state().since, detected);
  const double where = rig.pose()[0];
  EXPECT_GT(rig.context.get(rig.station.contact_force), 10.0);

  ASSERT_TRUE(rig.run_until(hold, 1s));
  rig.run(1s, [&rig] { ASSERT_EQ(rig.state().mode, hold); });
  EXPECT_EQ(rig.context.get(rig.station.contact_force), 0.0);
  EXPECT_NEAR(rig.pose()[0], where - 0.10, 2e-3);
  EXPECT_LT(rig.velocity().norm(), 1e-3);
  EXPECT_EQ(rig.gate().phase, GatePhase::open);
}

TEST(ContactControl, TakesEnergyOutAfterAHardContactUntilTheOperatorResetsAtRest) {
  Bench rig(RigExperiment{});
  rig.run(300ms);
  rig.push(Eigen::Vector3d(90.0, 0.0, 0.0));
  ASSERT_TRUE(rig.run_until(react, 100ms));
  ASSERT_TRUE(rig.run_until(zero_g, 300ms));
  rig.press({.start = false, .reset = true});
  rig.run(20ms);
  EXPECT_EQ(rig.state().mode, zero_g) << "still pushed";
  const JointVector& rates = rig.context.get(rig.control.joint_motion).velocity;
  EXPECT_LT(rig.torque().torque.dot(rates), 0.0);
  EXPECT_LT((rig.torque().torque.normalized() + rates.normalized()).norm(), 1e-12);
  rig.press({});
}

TEST(ContactControl, FloatsAsInThePapersWhereItIsAskedTo) {
  RigExperiment experiment;
  experiment.control.yielding.reset();
  Bench rig(experiment);
  rig.run(300ms);
  rig.push(Eigen::Vector3d(90.0, 0.0, 0.0));
  ASSERT_TRUE(rig.run_until(zero_g, 300ms));
  rig.run(20ms);
  EXPECT_LT(rig.torque().torque.norm(), 1e-9) << "no gravity in the plane";
}

TEST(ContactControl, LeavesZeroGravityAtRestOnReset) {
  Bench rig(RigExperiment{});
  rig.run(300ms);
  rig.push(Eigen::Vector3d(0.0, 120.0, 0.0));
  ASSERT_TRUE(rig.run_until(zero_g, 200ms));
  rig.push(PlatformVector());
  rig.run(500ms);
  EXPECT_LT(rig.velocity().head(2).norm(), 0.02) << "comes to rest by itself";
  ASSERT_EQ(rig.state().mode, zero_g);
  rig.press({.start = false, .reset = true});
  rig.tick();
  EXPECT_EQ(rig.state().mode, nominal);
  const Eigen::Vector3d here = rig.pose();
  rig.run(500ms);
  EXPECT_EQ(rig.state().mode, nominal);
  EXPECT_LT((rig.pose() - here).norm(), 2e-3);
}

TEST(ContactControl, HoldsItsPlaceAfterAResetAndGoesOnOnlyWhenStarted) {
  Bench rig(collision(0.5));
  ASSERT_TRUE(rig.run_until(hold, 3s));
  rig.run(500ms);
  const Eigen::Vector3d here = rig.pose();
  JointVector last = rig.torque().torque;
  rig.press({.start = false, .reset = true});
  rig.run(500ms, [&] {
    ASSERT_LT((rig.torque().torque - last).lpNorm<Eigen::Infinity>(), 1.0) << "no jump";
    last = rig.torque().torque;
  });
  EXPECT_EQ(rig.state().mode, nominal);
  EXPECT_LT((rig.pose() - here).norm(), 1e-3);
  rig.press({});
  rig.run(500ms);
  EXPECT_LT((rig.pose() - here).norm(), 1e-3);
  rig.press({.start = true, .reset = false});
  EXPECT_TRUE(rig.run_until(react, 3s)) << "into the wall once more";
}

TEST(ContactControl, RetreatsSofterWhereAskedTo) {
  RigExperiment experiment = collision(0.5);
  experiment.control.reaction_stiffness = 0.2;
  Bench rig(experiment);
  ASSERT_TRUE(rig.run_until(hold, 3s));
  rig.run(2s);
  const Eigen::Vector3d here = rig.pose();
  rig.push(Eigen::Vector3d(0.0, 8.0, 0.0));
  rig.run(3s);
  EXPECT_NEAR(rig.pose()[1] - here[1], 8.0 / 400.0, 2e-3) << "within friction";
}

// ---------------------------------------------------------------- faults

TEST(ContactControl, BrakesWhenTheEncodersAreLostAndRecoversOnReset) {
  Bench rig(collision(0.5));
  rig.run(400ms);
  ASSERT_EQ(rig.state().mode, nominal);
  ASSERT_GT(rig.velocity()[0], 0.4);
  rig.lose_encoders(true);
  rig.run(2ms);
  EXPECT_EQ(rig.gate().phase, GatePhase::open) << "two readings may be missing";
  rig.tick();
  EXPECT_EQ(rig.gate().fault, GateFault::joints_invalid);
  EXPECT_TRUE(rig.context.get(rig.control.brake).engage);
  rig.run(100ms);
  EXPECT_LT(rig.velocity().norm(), 1e-6);
  rig.lose_encoders(false);
  rig.run(400ms);
  EXPECT_EQ(rig.gate().phase, GatePhase::closed);
  EXPECT_EQ(rig.state().mode, stopped);
  const Eigen::Vector3d here = rig.pose();
  rig.press({.start = false, .reset = true});
  rig.run(1s);
  EXPECT_EQ(rig.gate().phase, GatePhase::open);
  EXPECT_EQ(rig.state().mode, nominal);
  EXPECT_LT((rig.pose() - here).norm(), 1e-3) << "does not go on by itself";
}

TEST(ContactControl, StopsBeforeTheRobotLeavesItsWorkspace) {
  RigExperiment experiment;
  experiment.control.sequence.zero_g_when_struck = false;
  experiment.control.contact_detector.reaction = {1e3, 1e3};
  experiment.control.contact_detector.hard = {1e3, 1e3};
  experiment.control.impedance.stiffness = Eigen::Vector3d(1.0, 1.0, 1.0);
  Bench rig(experiment);
  rig.run(300ms);
  rig.push(Eigen::Vector3d(0.0, 0.0, 1.5));  // turns it towards its singularity
  bool closed = false;
  rig.run(3s, [&] {
    closed = closed || rig.gate().phase == GatePhase::closed;
    if (closed) rig.push(PlatformVector());
  });
  EXPECT_TRUE(closed);
  EXPECT_EQ(rig.gate().reaction, GateReaction::controlled_stop);
  EXPECT_LT(rig.velocity().norm(), 1e-3);
}

TEST(ContactControl, WritesNoTorqueThatIsNoNumberWhateverTheStationSays) {
  const RigExperiment experiment;
  const auto robot = std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::none));
  DiagramBuilder builder("nonsense");
  const ContactControl control = add_contact_control(builder, robot, experiment.control);
  const auto joints = builder.export_input("joints", control.joints);
  const auto drives = builder.export_input("drives", control.drives);
  const auto status = builder.export_input("status", control.status);
  const auto buttons = builder.export_input("operator", control.operator_command);
  builder.export_input("tick_timing", control.tick_timing);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  RandomGenerator random(23);
  const JointAngles home = robot->inverse_kinematics(robot->home_pose(), robot->home_working_mode()).joints;
  const auto spoilt = [&random](JointVector values, double share) {
    for (double& value : values) {
      if (random.uniform(0.0, 1.0) < share) value = std::numeric_limits<double>::quiet_NaN();
    }
    return values;
  };
  int torques = 0;
  for (int k = 0; k < 20000; ++k) {
    const Time now = context.time();
    const double share = k % 1000 < 500 ? 0.0 : 0.02;
    const JointVector active = home.active + JointVector::Constant(3, 1e-5 * random.normal());
    context.set(joints, {now, true, true, spoilt(active, share), spoilt(home.passive, share)});
    context.set(drives, {now, true, spoilt(JointVector::Zero(3), share)});
    context.set(status, {.acquired = now, .valid = true, .enabled = true, .braked = false, .fault = false});
    context.set(buttons, {.start = false, .reset = k % 10 == 0});
    diagram->evaluate(context);
    diagram->update(context);
    context.set_time(now + diagram->tick());
    const TorqueCommand& torque = context.get(control.torque_command);
    ASSERT_TRUE(torque.torque.allFinite());
    ASSERT_EQ(context.get(control.brake).engage, !torque.valid);
    torques += torque.valid ? 1 : 0;
  }
  EXPECT_GT(torques, 1000);
}

// ---------------------------------------------------------------- real time, settings

TEST(ContactControl, NeverAllocatesInAnyMode) {
  Bench rig(collision(0.7));
  rig.tick();
  std::optional<test::AllocationCounter> counter(std::in_place);
  ASSERT_TRUE(rig.run_until(hold, 3s));
  rig.press({.start = false, .reset = true});
  rig.run(50ms);
  EXPECT_EQ(rig.state().mode, nominal);
  rig.push(Eigen::Vector3d(0.0, 120.0, 0.0));
  EXPECT_TRUE(rig.run_until(zero_g, 200ms));
  rig.lose_encoders(true);
  EXPECT_TRUE(rig.run_until(stopped, 10ms));
  EXPECT_EQ(counter->count(), 0);
}

TEST(ContactControl, RepeatsBitForBit) {
  Bench first(collision(0.5)), second(collision(0.5));
  first.run(2s), second.run(2s);
  EXPECT_EQ(first.pose(), second.pose());
  EXPECT_EQ(first.torque().torque, second.torque().torque);
}

TEST(ContactControl, RefusesSettingsThatDoNotFitTheRobot) {
  const auto robot = std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::none));
  const auto add = [&robot](const ContactControlSettings& settings) {
    DiagramBuilder builder;
    add_contact_control(builder, robot, settings);
  };
  EXPECT_NO_THROW(add({}));
  ContactControlSettings settings;
  settings.reaction_stiffness = 1.5;
  EXPECT_THROW(add(settings), SetupError);
  settings = {};
  settings.drive_torque.torque_constant = JointVector::Ones(2);
  EXPECT_THROW(add(settings), SetupError);
  settings = {};
  settings.impedance.stiffness = PlatformVector::Ones(6);
  EXPECT_THROW(add(settings), SetupError);
}

}  // namespace
}  // namespace flinch
