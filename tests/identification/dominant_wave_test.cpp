#include "identification/dominant_wave.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/framework/random.h"

namespace flinch {
namespace {

/// To and fro over 1.6 rad, with noise of this deviation and, of amplitude 0.5, a wave.
std::vector<WaveSample> samples(double rate, double noise, double factor = 1.0) {
  RandomGenerator random(1);
  std::vector<WaveSample> all;
  for (int k = 0; k < 2000; ++k) {
    const double position = 0.8 * std::sin(0.01 * k);
    all.push_back(
        {position, factor, factor * 0.5 * std::sin(rate * position + 1.0) + noise * random.normal()});
  }
  return all;
}

TEST(DominantWave, IsTheOneThatIsThere) {
  for (const double rate : {9.0, 24.0, 66.0}) {
    const Wave wave = dominant_wave(samples(rate, 0.1), 2.0, 0.1);
    EXPECT_NEAR(wave.rate, rate, wave.deviation) << rate;
    EXPECT_GT(wave.explained, 0.8);
  }
  EXPECT_NEAR(dominant_wave(samples(24.0, 0.1, 7.0), 2.0, 0.1).rate, 24.0, 0.5) << "times a torque";
}

// As a filter leaves it: of the fast places little, and they must not speak against the wave.
TEST(DominantWave, IsFoundWhereFastPlacesBlurIt) {
  std::vector<WaveSample> blurred = samples(66.0, 0.05);
  for (std::size_t k = 0; k < blurred.size(); ++k) {
    WaveSample& sample = blurred[k];
    sample.blur = 0.04 * std::abs(std::cos(0.01 * static_cast<double>(k)));
    sample.left /= 1.0 + std::pow(66.0 * sample.blur, 4);
  }
  const Wave wave = dominant_wave(blurred, 2.0, 0.1);
  EXPECT_NEAR(wave.rate, 66.0, wave.deviation);
  EXPECT_GT(wave.explained, 0.9);
  for (WaveSample& sample : blurred) sample.blur = 0.0;
  EXPECT_LT(dominant_wave(blurred, 2.0, 0.1).explained, 0.8) << "by a wave that is everywhere the same";
}

TEST(DominantWave, IsNoneInNoiseInAFewSamplesAndWhereItIsTooSlow) {
  EXPECT_EQ(dominant_wave(samples(24.0, 20.0), 2.0, 0.1).rate, 0.0);
  std::vector<WaveSample> few = samples(24.0, 0.1);
  few.resize(29);
  EXPECT_EQ(dominant_wave(few, 2.0, 0.1).rate, 0.0);
  const double slow = dominant_wave(samples(2.0, 0.1), 2.0, 0.1).rate;
  EXPECT_TRUE(slow == 0.0 || slow >= 2.0 * 2.0 * 3.14 / 1.6) << slow;
}

}  // namespace
}  // namespace flinch
