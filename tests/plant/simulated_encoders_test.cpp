#include "plant/simulated_encoders.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/foundation/setup_error.h"
#include "tests/plant/sensor_rig.h"

namespace flinch {
namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

/// Encoders that look at a truth which the test sets.
class Encoders {
 public:
  explicit Encoders(const SimulatedEncodersSettings& settings, std::uint64_t seed = 1)
      : ticking_(wire(settings, seed)) {}

  JointReading read(PlantTruth truth = test::truth_at_rest()) {
    truth.acquired = ticking_.now();
    ticking_.set(truth_, truth);
    ticking_.tick();
    return ticking_.get(joints_);
  }

 private:
  DiagramBuilder& wire(const SimulatedEncodersSettings& settings, std::uint64_t seed) {
    auto& encoders =
        builder_.add<SimulatedEncoders>("encoders", settings, JointCounts{.active = 3, .passive = 3}, seed);
    truth_ = builder_.export_input("truth", encoders.truth);
    joints_ = encoders.joints;
    return builder_;
  }

  DiagramBuilder builder_{"test", 1ms};
  InputPort<PlantTruth> truth_;
  OutputPort<JointReading> joints_;
  test::Ticking ticking_;
};

SimulatedEncodersSettings only_noise() {
  SimulatedEncodersSettings settings;
  settings.active.resolution = 0.0;
  return settings;
}

TEST(SimulatedEncoders, IdealOnesTellTheTruthWithItsTime) {
  Encoders encoders({.ideal = true});
  const PlantTruth truth = test::truth_at_rest();
  encoders.read();
  const JointReading reading = encoders.read();
  EXPECT_TRUE(reading.valid);
  EXPECT_TRUE(reading.passive_valid);
  EXPECT_EQ(reading.acquired, 1ms);
  EXPECT_EQ(reading.active, truth.active);
  EXPECT_EQ(reading.passive, truth.passive);
}

TEST(SimulatedEncoders, SitOnTheMotorsOfElasticDrives) {
  PlantTruth truth = test::truth_at_rest();
  EXPECT_EQ(truth.motor_positions(), truth.active);
  truth.motors = truth.active + Eigen::Vector3d(1e-3, -2e-3, 3e-3);
  Encoders encoders({.ideal = true});
  encoders.read(truth);
  EXPECT_EQ(encoders.read(truth).active, truth.motors);
}

TEST(SimulatedEncoders, AreOffByTheirOffsetAndByWhatRepeatsEveryTurn) {
  SimulatedEncodersSettings settings;
  settings.active = {.wave = {{1e-4, 1.0, 0.2}, {2e-4, 1.0, 1.0}, {0.0, 1.0, 0.0}}};
  settings.passive = {.offset = Eigen::Vector3d(1e-3, -2e-3, 0.0)};
  Encoders encoders(settings);
  const PlantTruth truth = test::truth_at_rest();
  encoders.read();
  const JointReading reading = encoders.read();
  const Eigen::Vector3d wave(1e-4 * std::sin(0.4 + 0.2), 2e-4 * std::sin(-0.3 + 1.0), 0.0);
  EXPECT_LT((reading.active - truth.active - wave).norm(), 1e-15);
  EXPECT_LT((reading.passive - truth.passive - Eigen::Vector3d(1e-3, -2e-3, 0.0)).norm(), 1e-15);
}

TEST(SimulatedEncoders, RefuseErrorsOfAnotherNumberOfEncoders) {
  SimulatedEncodersSettings settings;
  settings.active.wave.resize(2);
  EXPECT_THROW(Encoders encoders(settings), SetupError);
  settings = {};
  settings.passive.offset = Eigen::Vector2d(0.1, 0.1);
  EXPECT_THROW(Encoders encoders(settings), SetupError);
}

TEST(SimulatedEncoders, ActiveNoiseIsWhiteWithTheGivenDeviation) {
  Encoders encoders(only_noise());
  const PlantTruth truth = test::truth_at_rest();
  const double sigma = 4e-4 * degree;
  for (int axis = 0; axis < 3; ++axis) {
    test::Statistics noise;
    test::Statistics neighbours;
    double previous = 0.0;
    constexpr int samples = 20000;
    for (int k = 0; k < samples; ++k) {
      const double error = (encoders.read().active[axis] - truth.active[axis]) / sigma;
      noise.add(error);
      neighbours.add(error * previous);
      previous = error;
    }
    const double four_sigma = 4.0 / std::sqrt(samples);
    EXPECT_NEAR(noise.mean(), 0.0, four_sigma);
    EXPECT_NEAR(noise.deviation(), 1.0, four_sigma);
    EXPECT_NEAR(neighbours.mean(), 0.0, four_sigma);
  }
}

TEST(SimulatedEncoders, ReadingsAreMultiplesOfTheResolution) {
  Encoders encoders({});
  for (int k = 0; k < 100; ++k) {
    const JointReading reading = encoders.read();
    for (int axis = 0; axis < 3; ++axis) {
      const double active_steps = reading.active[axis] / (1.2e-5 * degree);
      const double passive_steps = reading.passive[axis] / (0.025 * degree);
      EXPECT_NEAR(active_steps, std::round(active_steps), 1e-6);
      EXPECT_NEAR(passive_steps, std::round(passive_steps), 1e-9);
    }
  }
}

TEST(SimulatedEncoders, PassiveErrorsAreConstantAndSpreadWithTheAccuracy) {
  SimulatedEncodersSettings settings;
  settings.passive.resolution = 0.0;
  const PlantTruth truth = test::truth_at_rest();
  test::Statistics errors;
  constexpr int rigs = 700;
  for (std::uint64_t seed = 0; seed < rigs; ++seed) {
    Encoders encoders(settings, seed);
    const JointReading first = encoders.read();
    EXPECT_EQ(encoders.read().passive, first.passive);
    for (int axis = 0; axis < 3; ++axis) errors.add(first.passive[axis] - truth.passive[axis]);
  }
  const double sigma = 0.1 * degree;
  const double four_sigma = 4.0 / std::sqrt(3.0 * rigs);
  EXPECT_NEAR(errors.mean() / sigma, 0.0, four_sigma);
  EXPECT_NEAR(errors.deviation() / sigma, 1.0, four_sigma);
}

TEST(SimulatedEncoders, AreTheSameForTheSameSeedOnly) {
  Encoders a({}, 5);
  Encoders b({}, 5);
  Encoders c({}, 6);
  for (int k = 0; k < 10; ++k) {
    const JointReading reading = a.read();
    EXPECT_EQ(reading.active, b.read().active);
    EXPECT_NE(reading.active, c.read().active);
  }
}

TEST(SimulatedEncoders, WithoutPassiveEncodersSaySo) {
  Encoders encoders({.passive_mounted = false});
  EXPECT_TRUE(encoders.read().valid);
  EXPECT_FALSE(encoders.read().passive_valid);
}

TEST(SimulatedEncoders, OfARobotThatCameApartAreNotValid) {
  Encoders encoders({});
  const JointReading reading = encoders.read(PlantTruth());
  EXPECT_FALSE(reading.valid);
  EXPECT_FALSE(reading.passive_valid);
  EXPECT_EQ(reading.active.size(), 0);
}

}  // namespace
}  // namespace flinch
