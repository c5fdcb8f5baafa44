#include "systems/estimators/disturbance_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/framework/runge_kutta.h"
#include "systems/framework/simulator.h"
#include "systems/model/forward_kinematics.h"
#include "systems/model/robot_model.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/sensors/drive_torque_mapping.h"
#include "systems/sensors/velocity_filter.h"
#include "tests/support/answer_of_filters.h"
#include "tests/support/moving_robot.h"
#include "tests/support/told_disturbance_filter.h"

namespace flinch {
namespace {

std::shared_ptr<const PlanarRrr> rig() {
  return std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::simulation));
}

/// Adds noise to the encoders.
class Noise final : public System {
  State<RandomGenerator> random_ = state<RandomGenerator>("random", RandomGenerator(3));

 public:
  explicit Noise(double deviation) : deviation_(deviation) {}
  InputPort<JointReading> exact = input<JointReading>("exact");
  OutputPort<JointReading> joints = output<&Noise::add>("joints", exact, random_);

 private:
  Update draw_ = update<&Noise::draw>(random_);
  void add(const JointReading& reading, const RandomGenerator& random, JointReading& result) const {
    result = reading;
    RandomGenerator numbers = random;
    for (int i = 0; i < 3; ++i) result.active[i] += deviation_ * numbers.normal();
  }
  void draw(RandomGenerator& random) const {
    for (int i = 0; i < 10; ++i) random();
  }
  double deviation_;
};

/// The filter on the moving robot, which is pushed by a constant wrench from 300 ms on.
class Chain {
 public:
  Chain(const PlatformVector& push, double encoder_noise) {
    const auto robot = rig();
    auto& plant = test::add_moving_robot(builder_, robot, push, 300ms);
    auto& noise = builder_.add<Noise>("noise", encoder_noise);
    auto& velocity = builder_.add<VelocityFilter>("velocity", robot);
    auto& pose = builder_.add<ForwardKinematics>("pose", robot);
    auto& model = builder_.add<RobotModel>("model", robot);
    auto& torque =
        builder_.add<DriveTorqueMapping>("torque", robot, DriveTorqueSettings{JointVector::Ones(3), {}});
    filter_ = &builder_.add<DisturbanceFilter>("filter", robot, DisturbanceFilterSettings{});
    builder_.connect(builder_.optional_input<StationStatus>("brakes"), torque.status);
    builder_.connect(plant.joints, noise.exact);
    builder_.connect(noise.joints, torque.joints);
    builder_.connect(noise.joints, velocity.joints);
    builder_.connect(noise.joints, pose.joints);
    builder_.connect(noise.joints, filter_->joints);
    builder_.connect(velocity.motion, pose.motion);
    builder_.connect(pose.platform, model.platform);
    builder_.connect(pose.platform, filter_->platform);
    builder_.connect(model.kinematics, filter_->kinematics);
    builder_.connect(model.dynamics, filter_->dynamics);
    builder_.connect(plant.drives, torque.drives);
    builder_.connect(torque.torque, filter_->torque);
    diagram_ = builder_.build();
    context_.emplace(diagram_->make_context());
    simulator_.emplace(*diagram_, std::make_unique<RungeKutta>(4));
  }
  const WrenchEstimate& tick() {
    simulator_->step(*context_);
    return context_->get(filter_->wrench);
  }

 private:
  DiagramBuilder builder_{"chain", 1ms};
  DisturbanceFilter* filter_ = nullptr;
  std::unique_ptr<Diagram> diagram_;
  std::optional<Context> context_;
  std::optional<Simulator> simulator_;
};

const PlatformVector push{{25.0, -40.0, 3.0}};

TEST(DisturbanceFilter, AnswersAPushOnTheMovingRobotByItsThreefoldPole) {
  Chain chain(push, 0.0);
  for (int k = 0; k < 600; ++k) {
    const WrenchEstimate& seen = chain.tick();
    ASSERT_EQ(seen.valid, k >= 35) << k;
    if (!seen.valid) continue;
    const double answer = test::answer_of_three_filters(300.0 * (k - 300.5) * 1e-3);
    const double transient = k >= 301 && k < 320 ? 0.08 : 0.015;
    ASSERT_LT((seen.wrench_in_base - answer * push).norm(), transient * push.norm() + 0.2) << k;
  }
}

TEST(DisturbanceFilter, TellsTheDeviationThatTheNoiseOfTheEncodersCauses) {
  Chain noisy(PlatformVector::Zero(3), DisturbanceFilterSettings{}.encoder_deviation);
  Chain exact(PlatformVector::Zero(3), 0.0);
  PlatformVector ratio = PlatformVector::Zero(3);
  for (int k = 0; k < 6000; ++k) {
    const PlatformVector expected = exact.tick().wrench_in_base;
    const WrenchEstimate& seen = noisy.tick();
    if (k < 100) continue;
    ratio += (seen.wrench_in_base - expected).cwiseQuotient(seen.standard_deviation).cwiseAbs2() / 5900.0;
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::sqrt(ratio[i]), 1.0, 0.15) << i;
}

TEST(DisturbanceFilter, NoticesNoiseThatItWasNotToldOf) {
  for (const double times : {0.0, 1.0, 3.0}) {
    Chain chain(PlatformVector::Zero(3), times * DisturbanceFilterSettings{}.encoder_deviation);
    double mean = 0.0;
    for (int k = 0; k < 6000; ++k) {
      const EstimatorHealth& health = chain.tick().health;
      if (k >= 1000) mean += health.innovation / 5000.0;
    }
    std::printf("encoders %.0f times as noisy as told: innovation %.3f\n", times, mean);
    EXPECT_NEAR(mean, times * times, 0.05 + 0.05 * times * times);
  }
}

/// The filter at a robot whose encoders and rates are noisy, which moves as told.
class Held {
 public:
  explicit Held(std::uint64_t seed) : random_(seed) {}

  /// A tick in which the drives have these rates, and what is followed then.
  void tick(bool braked, const PlatformVector& velocity = PlatformVector::Zero(3)) {
    PlatformVector noisy = velocity;
    for (int i = 0; i < 3; ++i) noisy[i] += (i < 2 ? 5e-4 : 2e-3) * random_.normal();
    test::Posture at(*robot_, Configuration::Zero(3), noisy, filter_.now());
    for (int i = 0; i < 3; ++i)
      at.joints.active[i] += DisturbanceFilterSettings{}.encoder_deviation * random_.normal();
    filter_.tick(at, JointVector::Zero(3), braked);
  }
  double effort() const { return filter_.wrench().drive_torque.norm(); }
  PlatformVector velocity() const { return filter_.followed().velocity; }

 private:
  std::shared_ptr<const PlanarRrr> robot_ = test::planar_rig(RigFriction::test_rig);
  RandomGenerator random_;
  test::ToldDisturbanceFilter filter_{robot_};
};

TEST(DisturbanceFilter, IsNoNoisierWhenBrakesHaveJustOpened) {
  double opened = 0.0, later = 0.0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Held held(seed);
    for (int k = 0; k < 60; ++k) held.tick(true);
    for (int k = 0; k < 20; ++k) {
      held.tick(false);
      opened += std::pow(held.effort(), 2);
    }
    for (int k = 0; k < 100; ++k) held.tick(false);
    for (int k = 0; k < 20; ++k) {
      held.tick(false);
      later += std::pow(held.effort(), 2);
    }
  }
  std::printf("in the first 20 ms after brakes %.2f of the deviation that is usual\n",
              std::sqrt(opened / later));
  EXPECT_GT(later, 0.0);
  EXPECT_LT(std::sqrt(opened / later), 1.1);
}

TEST(DisturbanceFilter, BeginsAtRestWhereBrakesHeldTheDrivesAndInMotionWhereTheyMoved) {
  const PlatformVector moving{{0.1, 0.0, 0.0}};
  Held held(1);
  for (int k = 0; k < 60; ++k) held.tick(true);
  EXPECT_GT(held.velocity().norm(), 0.0);
  held.tick(false);
  EXPECT_EQ(held.velocity().norm(), 0.0);
  held.tick(true, moving);
  held.tick(false, moving);
  EXPECT_NEAR(held.velocity()[0], 0.1, 0.01);
}

TEST(DisturbanceFilter, AsksForSettingsThatArePositive) {
  DisturbanceFilterSettings settings;
  settings.pole = 0.0;
  settings.encoder_deviation = std::numeric_limits<double>::quiet_NaN();
  try {
    const DisturbanceFilter filter(rig(), settings);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 2U);
  }
}

}  // namespace
}  // namespace flinch
