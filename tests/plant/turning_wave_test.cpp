#include "plant/turning_wave.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "systems/robot/planar_leg.h"

namespace flinch {
namespace {

TEST(TurningHarmonic, IsTheWaveOfItsPosition) {
  for (const int times : {0, 1, 2, 24, 66, 1000}) {
    const PositionHarmonic wave{.amplitude = 0.5, .rate = static_cast<double>(times), .phase = -0.7};
    ASSERT_TRUE(repeats_each_turn(wave));
    const TurningHarmonic turning(wave);
    for (double angle = -std::numbers::pi; angle < std::numbers::pi; angle += 0.01)
      EXPECT_NEAR(turning.at(unit_vector(angle)), wave.at(angle), 1e-15 * (2.0 + times)) << times;
  }
}

TEST(TurningHarmonic, IsZeroWithoutAmplitude) {
  EXPECT_EQ(TurningHarmonic().at(unit_vector(0.4)), 0.0);
  EXPECT_EQ(
      TurningHarmonic(PositionHarmonic{.amplitude = 0.0, .rate = 3.0, .phase = 1.0}).at(unit_vector(0.4)),
      0.0);
}

TEST(TurningHarmonic, StandsForNoOtherWave) {
  EXPECT_FALSE(repeats_each_turn({.amplitude = 1.0, .rate = 2.5, .phase = 0.0}));
  EXPECT_FALSE(repeats_each_turn({.amplitude = 1.0, .rate = -2.0, .phase = 0.0}));
  EXPECT_FALSE(repeats_each_turn({.amplitude = 1.0, .rate = 3e4, .phase = 0.0}));
  EXPECT_FALSE(repeats_each_turn({.amplitude = 1.0, .rate = NAN, .phase = 0.0}));
}

}  // namespace
}  // namespace flinch
