// The momentum observer on the whole robot, moving as fast as the rig does.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "systems/contact/contact_detector.h"
#include "systems/estimators/momentum_observer.h"
#include "systems/framework/simulator.h"
#include "systems/model/forward_kinematics.h"
#include "systems/model/robot_model.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/sensors/drive_torque_mapping.h"
#include "systems/sensors/velocity_filter.h"
#include "tests/support/moving_robot.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

const PlatformVector contact{{25.0, -40.0, 3.0}};
const PlatformVector no_contact = PlatformVector::Zero(3);

std::shared_ptr<const PlanarRrr> rig(RigGeometry geometry = RigGeometry::individual) {
  return std::make_shared<PlanarRrr>(rig_robot(geometry, RigFriction::simulation));
}

MomentumObserverSettings observer_settings(double gain, TorqueTiming timing, Time period = 1ms) {
  return {PlatformVector::Constant(3, gain), timing, Sampling{period, 2 * period}};
}

// ---------------------------------------------------------------- exact instants, no plant

/// The observer behind the model, fed with pose, velocity and torque of each instant as the equation of
/// motion has them.
struct ExactChain {
  ExactChain(std::shared_ptr<const PlanarRrr> modelled, double gain, Time period)
      : robot(std::move(modelled)),
        builder("exact", period),
        model(builder.add<RobotModel>("model", robot)),
        observer(builder.add<MomentumObserver>("observer", robot,
                                               observer_settings(gain, TorqueTiming::sampled, period))),
        platform(builder.input<PlatformMotion>("platform")),
        torque(builder.export_input("torque", observer.torque)),
        ticking(connect()) {}

  const WrenchEstimate& see(const test::SmoothTrajectory& motion, const PlatformVector& F_ext) {
    const Time now = ticking.now();
    Kinematics kinematics;
    Dynamics dynamics;
    robot->kinematics(motion.pose, motion.velocity, kinematics);
    robot->dynamics(kinematics, dynamics);
    const PlatformVector F_a = dynamics.M_x * PlatformVector(motion.acceleration) +
                               dynamics.C_x * PlatformVector(motion.velocity) + dynamics.F_fr_x - F_ext;
    ticking.set(platform, {now, PlatformMotion::Status::valid, motion.pose, motion.velocity});
    ticking.set(torque, {now, true, drive_torques(kinematics, F_a)});
    ticking.tick();
    return ticking.get(observer.wrench);
  }

  std::shared_ptr<const PlanarRrr> robot;
  DiagramBuilder builder;
  RobotModel& model;
  MomentumObserver& observer;
  InputPort<PlatformMotion> platform;
  InputPort<DriveTorque> torque;
  test::Ticking ticking;

 private:
  DiagramBuilder& connect() {
    builder.connect(platform, model.platform);
    builder.connect(platform, observer.platform);
    builder.connect(model.kinematics, observer.kinematics);
    builder.connect(model.dynamics, observer.dynamics);
    return builder;
  }
};

/// Largest difference in one second between the estimate and its law, 1 - exp(-k_o t) of the true wrench.
double largest_error(double gain, Time period) {
  ExactChain chain(rig(), gain, period);
  double largest = 0.0;
  while (chain.ticking.now() < 1s) {
    const double t = to_seconds(chain.ticking.now());
    const PlatformVector estimate = chain.see(test::SmoothTrajectory(t), contact).wrench_in_base;
    largest = std::max(largest, (estimate - (1.0 - std::exp(-gain * t)) * contact).lpNorm<Eigen::Infinity>());
  }
  return largest;
}

TEST(MomentumObserverOnARobot, ConvergesToAKnownWrenchInSecondOrderOfTheSampleTime) {
  for (const double gain : {20.0, 135.0}) {
    const double at_2ms = largest_error(gain, 2ms);
    const double at_1ms = largest_error(gain, 1ms);
    const double at_500us = largest_error(gain, 500us);
    RecordProperty("at_1ms_uN", static_cast<int>(1e6 * at_1ms));
    EXPECT_LT(at_1ms, 0.01);
    EXPECT_NEAR(at_2ms / at_1ms, 4.0, 0.2);
    EXPECT_NEAR(at_1ms / at_500us, 4.0, 0.2);
  }
}

// The nominal robot looks the same after a third of a turn, one leg on: so must what it feels.
TEST(MomentumObserverOnARobot, FeelsTheSameAfterAThirdOfATurn) {
  const double turn = 2.0 / 3.0 * std::numbers::pi;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2D<double>(turn).toRotationMatrix();

  ExactChain chain(rig(RigGeometry::nominal), 135.0, 1ms);
  ExactChain turned(rig(RigGeometry::nominal), 135.0, 1ms);
  while (chain.ticking.now() < 1s) {
    const test::SmoothTrajectory motion(to_seconds(chain.ticking.now()));
    test::SmoothTrajectory turned_motion = motion;
    turned_motion.pose = R * motion.pose;
    turned_motion.velocity = R * motion.velocity;
    turned_motion.acceleration = R * motion.acceleration;
    const WrenchEstimate& estimate = chain.see(motion, contact);
    const WrenchEstimate& turned_estimate = turned.see(turned_motion, PlatformVector(R * contact));
    ASSERT_LT((turned_estimate.wrench_in_base - R * estimate.wrench_in_base).norm(), 1e-8);
    const JointVector& torque = estimate.drive_torque;
    ASSERT_LT((turned_estimate.drive_torque - JointVector{{torque[2], torque[0], torque[1]}}).norm(), 1e-8);
  }
}

// ---------------------------------------------------------------- a plant, encoders and currents

/// Pose and velocity as the plant has them.
class ExactMotion final : public System {
 public:
  InputPort<test::PlanarState> state = input<test::PlanarState>("state");
  OutputPort<PlatformMotion> platform = output<&ExactMotion::tell>("platform", state, clock);

 private:
  PlatformMotion tell(const test::PlanarState& plant, Time now) const {
    return {now, PlatformMotion::Status::valid, plant.head<3>(), plant.tail<3>()};
  }
};

/// Largest force that an observer with exact velocities sees while the robot moves freely, its torque held
/// from tick to tick.
double residual_with_exact_velocity(TorqueTiming timing) {
  const auto robot = rig();
  DiagramBuilder builder("exact velocity");
  auto& plant = test::add_moving_robot(builder, robot, no_contact, 0ms);
  auto& motion = builder.add<ExactMotion>("motion");
  auto& model = builder.add<RobotModel>("model", robot);
  auto& torque =
      builder.add<DriveTorqueMapping>("torque", robot, DriveTorqueSettings{JointVector::Ones(3), {}});
  builder.connect(builder.optional_input<JointReading>("encoders"), torque.joints);
  builder.connect(builder.optional_input<StationStatus>("brakes"), torque.status);
  auto& observer = builder.add<MomentumObserver>("observer", robot, observer_settings(135.0, timing));
  builder.connect(plant.state, motion.state);
  builder.connect(plant.drives, torque.drives);
  builder.connect(motion.platform, model.platform);
  builder.connect(motion.platform, observer.platform);
  builder.connect(model.kinematics, observer.kinematics);
  builder.connect(model.dynamics, observer.dynamics);
  builder.connect(torque.torque, observer.torque);
  const auto diagram = builder.build();
  Simulator simulator(*diagram);
  Context context = diagram->make_context();
  double force = 0.0;
  while (context.time() < 1s) {
    simulator.step(context);
    force = std::max(force, context.get(observer.wrench).wrench_in_base.head(2).lpNorm<Eigen::Infinity>());
  }
  return force;
}

// The reading at t_k tells the torque of the interval that has just ended. Taken for that at t_k it acts half
// a sample late.
TEST(MomentumObserverOnARobot, ExplainsAFreeMotionBestWithTheTorqueWhereItActed) {
  const double held = residual_with_exact_velocity(TorqueTiming::held);
  const double sampled = residual_with_exact_velocity(TorqueTiming::sampled);
  RecordProperty("held_uN", static_cast<int>(1e6 * held));
  RecordProperty("sampled_uN", static_cast<int>(1e6 * sampled));
  EXPECT_LT(held, 0.01);
  EXPECT_GT(sampled, 10.0 * held);
}

/// Loses the first `missing` of every `period` readings.
class LossyEncoders final : public System {
 public:
  LossyEncoders(int missing, int period) : missing_(missing), period_(period) {}
  InputPort<JointReading> sent = input<JointReading>("sent");
  OutputPort<JointReading> joints = output<&LossyEncoders::lose>("joints", sent, clock);

 private:
  JointReading lose(const JointReading& reading, Time now) const {
    JointReading received = reading;
    if (now > 0ms && now / 1ms % period_ < missing_) received.valid = received.passive_valid = false;
    return received;
  }
  int missing_;
  int period_;
};

struct ChainSettings {
  double gain = 20.0;
  TorqueTiming timing = TorqueTiming::sampled;
  LowPassSettings velocity;
  std::optional<LowPassSettings> torque;
  int missing = 0;     ///< readings in a row
  int of_every = 337;  ///< readings
};

/// From encoders and currents of a simulated robot to the wrench, and to its detection.
class MeasuredChain {
 public:
  explicit MeasuredChain(const ChainSettings& settings, const PlatformVector& wrench = no_contact,
                         Time begin = 0ms) {
    const auto robot = rig();
    const DriveTorqueSettings drives{JointVector::Ones(3), {}};
    DiagramBuilder builder("measured");
    auto& plant = test::add_moving_robot(builder, robot, wrench, begin);
    auto& encoders = builder.add<LossyEncoders>("encoders", settings.missing, settings.of_every);
    auto& velocity =
        builder.add<VelocityFilter>("velocity", robot, VelocityFilterSettings{settings.velocity, {}});
    auto& pose = builder.add<ForwardKinematics>("pose", robot);
    auto& model = builder.add<RobotModel>("model", robot);
    auto& torque = builder.add<DriveTorqueMapping>("torque", robot, drives, settings.torque);
    builder.connect(builder.optional_input<JointReading>("encoders"), torque.joints);
    builder.connect(builder.optional_input<StationStatus>("brakes"), torque.status);
    auto& observer =
        builder.add<MomentumObserver>("observer", robot, observer_settings(settings.gain, settings.timing));
    auto& detector = builder.add<ContactDetector>("detector", robot);
    builder.connect(plant.joints, encoders.sent);
    builder.connect(encoders.joints, velocity.joints);
    builder.connect(encoders.joints, pose.joints);
    builder.connect(plant.drives, torque.drives);
    builder.connect(velocity.motion, pose.motion);
    builder.connect(pose.platform, model.platform);
    builder.connect(pose.platform, observer.platform);
    builder.connect(model.kinematics, observer.kinematics);
    builder.connect(model.dynamics, observer.dynamics);
    builder.connect(torque.torque, observer.torque);
    builder.connect(observer.wrench, detector.wrench);
    builder.export_input("reset", detector.reset);
    wrench_ = observer.wrench;
    contact_ = detector.contact;
    diagram_ = builder.build();
    context_.emplace(*diagram_);
    simulator_.emplace(*diagram_);
  }

  void run_until(Time end) { simulator_->advance_to(*context_, end); }
  const WrenchEstimate& wrench() const { return context_->get(wrench_); }
  const ContactDetection& detection() const { return context_->get(contact_); }

  /// Largest magnitudes of valid force components and moment while the robot moves freely.
  std::pair<double, double> residual() {
    double force = 0.0;
    double moment = 0.0;
    bool any_valid = false;
    for (Time now = 600ms; now < 2s; now += 1ms) {
      run_until(now);
      any_valid = any_valid || wrench().valid;
      if (!wrench().valid) continue;
      force = std::max(force, wrench().wrench_in_base.head(2).lpNorm<Eigen::Infinity>());
      moment = std::max(moment, std::abs(wrench().wrench_in_base[2]));
    }
    EXPECT_TRUE(any_valid);
    return {force, moment};
  }

 private:
  OutputPort<WrenchEstimate> wrench_;
  OutputPort<ContactDetection> contact_;
  std::unique_ptr<Diagram> diagram_;
  std::optional<Context> context_;
  std::optional<Simulator> simulator_;
};

TEST(MomentumObserverOnARobot, ExplainsAFreeMotionSeveralTimesBetterWithTheTorqueAligned) {
  for (const double gain : {20.0, 135.0, 500.0}) {
    for (const LowPassForm form : {LowPassForm::tustin, LowPassForm::backward_difference}) {
      ChainSettings settings{.gain = gain, .velocity = {30.0, form}, .torque = {}};
      const auto [force, moment] = MeasuredChain(settings).residual();
      settings.torque = settings.velocity;
      const auto [aligned_force, aligned_moment] = MeasuredChain(settings).residual();
      RecordProperty("force_mN", static_cast<int>(1e3 * force));
      RecordProperty("aligned_force_mN", static_cast<int>(1e3 * aligned_force));
      EXPECT_LT(aligned_force, force / 5.0);
      EXPECT_LT(aligned_moment, moment / 1.5);
    }
  }
}

// The same filter for both, and the mean of both ends: anything else leaves half a sample of skew.
TEST(MomentumObserverOnARobot, NoticesHalfASampleOfSkew) {
  ChainSettings settings{.gain = 135.0, .velocity = {30.0, LowPassForm::tustin}, .torque = {}};
  settings.torque = settings.velocity;
  const double aligned = MeasuredChain(settings).residual().first;

  ChainSettings late_velocity = settings;
  late_velocity.velocity.form = LowPassForm::backward_difference;
  EXPECT_GT(MeasuredChain(late_velocity).residual().first, 1.5 * aligned);

  ChainSettings early_torque = settings;
  early_torque.timing = TorqueTiming::held;
  EXPECT_GT(MeasuredChain(early_torque).residual().first, 1.5 * aligned);
}

// After five the observer starts anew, and so does the velocity filter: without the lag that it will have.
TEST(MomentumObserverOnARobot, DoesNotTakeMissingReadingsForAContact) {
  for (const double gain : {20.0, 135.0, 500.0}) {
    ChainSettings settings{.gain = gain, .velocity = {}, .torque = LowPassSettings{}};
    const double complete = MeasuredChain(settings).residual().first;
    for (const int missing : {1, 2, 5}) {
      settings.missing = missing;
      settings.of_every = missing == 5 ? 337 : 37;  // time to settle again
      const double force = MeasuredChain(settings).residual().first;
      EXPECT_LT(force, missing < 3 ? 1.5 * complete : 3.0 * complete) << gain << " 1/s, " << missing;
    }
  }
}

TEST(MomentumObserverOnARobot, FindsAWrenchThatBeginsWhileTheRobotMoves) {
  ChainSettings settings{.gain = 135.0, .velocity = {}, .torque = LowPassSettings{}};
  MeasuredChain chain(settings, contact, 700ms);
  chain.run_until(700ms);
  ASSERT_TRUE(chain.detection().valid);
  ASSERT_EQ(chain.detection().level, ContactLevel::none);
  chain.run_until(800ms);
  EXPECT_EQ(chain.detection().level, ContactLevel::hard);  // 3 Nm
  EXPECT_GT(chain.detection().detected, 700ms);
  EXPECT_LE(chain.detection().detected, 710ms);
  const PlatformVector error = chain.wrench().wrench_in_base - contact;
  EXPECT_LT(error.head(2).norm(), 1.5);
  EXPECT_LT(std::abs(error[2]), 0.3);
}

}  // namespace
}  // namespace flinch
