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
