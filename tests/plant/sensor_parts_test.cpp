#include <gtest/gtest.h>

#include <cmath>

#include "plant/delay_line.h"
#include "plant/quantisation.h"
#include "plant/sensor_noise.h"
#include "tests/plant/sensor_rig.h"

namespace flinch {
namespace {

struct Sample {
  Time acquired{};
  int value = 0;
};

TEST(DelayLine, GivesTheLatestSampleThatIsOldEnough) {
  DelayLine<Sample> line;
  EXPECT_EQ(line.latest_until(1s), nullptr);
  for (int k = 0; k < 40; ++k) {
    line.push({1ms * k, k});
    for (int age = 0; age < 10 && age <= k; ++age) {
      const Sample* sample = line.latest_until(1ms * (k - age) + 400us);
      ASSERT_NE(sample, nullptr);
      EXPECT_EQ(sample->value, k - age);
    }
  }
}

TEST(DelayLine, HasNoSampleOlderThanItsMemory) {
  DelayLine<Sample> line;
  for (int k = 0; k < 40; ++k) line.push({1ms * k, k});
  EXPECT_EQ(line.latest_until(1ms), nullptr);
  EXPECT_TRUE(DelayLine<Sample>::can_delay(14ms, 1ms));
  EXPECT_FALSE(DelayLine<Sample>::can_delay(15ms, 1ms));
}

TEST(Quantised, RoundsToTheNearestMultiple) {
  EXPECT_DOUBLE_EQ(quantised(0.26, 0.1), 0.3);
  EXPECT_DOUBLE_EQ(quantised(-0.26, 0.1), -0.3);
  EXPECT_EQ(quantised(0.123456, 0.0), 0.123456);
  EXPECT_TRUE(quantised(Eigen::Vector3d(0.26, -0.24, 1.0), 0.1).isApprox(Eigen::Vector3d(0.3, -0.2, 1.0)));
}

TEST(Quantised, ErrsByTheDeviationOfUniformNoise) {
  RandomGenerator random(3);
  test::Statistics error;
  constexpr int samples = 20000;
  for (int k = 0; k < samples; ++k) {
    const double value = random.uniform(-10.0, 10.0);
    error.add(quantised(value, 0.5) - value);
  }
  EXPECT_NEAR(error.mean(), 0.0, 4.0 * 0.5 / std::sqrt(12.0 * samples));
  EXPECT_NEAR(error.deviation(), 0.5 / std::sqrt(12.0), 0.003);
}

TEST(NormalNumbers, AreIndependentAndChangeWithEveryDraw) {
  NormalNumbers<2> numbers(2, 7);
  test::Statistics first;
  test::Statistics product;
  constexpr int samples = 20000;
  for (int k = 0; k < samples; ++k) {
    first.add(numbers.values()[0]);
    product.add(numbers.values()[0] * numbers.values()[1]);
    const Eigen::Vector2d before = numbers.values();
    numbers.draw();
    ASSERT_NE(numbers.values(), before);
  }
  const double four_sigma = 4.0 / std::sqrt(samples);
  EXPECT_NEAR(first.mean(), 0.0, four_sigma);
  EXPECT_NEAR(first.deviation(), 1.0, four_sigma);
  EXPECT_NEAR(product.mean(), 0.0, four_sigma);
}

TEST(NoiseDeviation, IsThatOfTheDensityUpToHalfTheSampleRate) {
  EXPECT_NEAR(noise_deviation(180e-6 * 9.80665, 1ms), 0.0395, 5e-5);
  EXPECT_NEAR(noise_deviation(0.007, 1ms), 0.157, 5e-4);
  EXPECT_DOUBLE_EQ(noise_deviation(1.0, 4ms), noise_deviation(1.0, 1ms) / 2.0);
}

TEST(ConstantErrors, AreDrawnFromTheirDistributions) {
  RandomGenerator random(4);
  test::Statistics normal;
  test::Statistics uniform;
  constexpr int draws = 20000;
  for (int k = 0; k < draws; ++k) {
    normal.add(normal_vector(random, 3, 2.0)[1]);
    const Eigen::Vector3d bounded = uniform_vector(random, 3.0);
    EXPECT_LE(bounded.cwiseAbs().maxCoeff(), 3.0);
    uniform.add(bounded.z());
  }
  EXPECT_NEAR(normal.deviation(), 2.0, 0.05);
  EXPECT_NEAR(uniform.deviation(), 3.0 / std::sqrt(3.0), 0.03);
}

}  // namespace
}  // namespace flinch
