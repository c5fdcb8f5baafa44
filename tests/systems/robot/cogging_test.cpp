#include "systems/robot/cogging.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace flinch {
namespace {

constexpr double pi = std::numbers::pi;

/// Of two drives.
Cogging some() { return {{{JointVector{{0.25, 2.0}}, JointVector{{0.3, 0.0}}, JointVector{{0.4, -1.0}}}}}; }

TEST(Cogging, RepeatsAlongTheWay) {
  const Cogging cogging = some();
  EXPECT_LT((cogging.at(JointVector{{0.0, 0.0}}) - JointVector{{0.4, -1.0}}).norm(), 1e-15);
  EXPECT_LT((cogging.at(JointVector{{0.0625, 0.5}}) - JointVector{{0.3, 0.0}}).norm(), 1e-15);
  EXPECT_LT((cogging.at(JointVector{{0.0625 + 0.75, 0.5 - 4.0}}) - JointVector{{0.3, 0.0}}).norm(), 1e-14);
}

// 0.3 sin + 0.4 cos is 0.5 sin with a phase.
TEST(Cogging, IsAWaveOfEachDrive) {
  const double phase = std::atan2(0.4, 0.3);
  for (const double q : {-3.0, -0.2, 0.01, 0.7, 2.5}) {
    EXPECT_NEAR(some().at(JointVector{{q, q}})[0], 0.5 * std::sin(2.0 * pi * q / 0.25 + phase), 1e-14);
  }
}

// sin x + sin 3x / 3 at a quarter of the wave is 1 - 1/3.
TEST(Cogging, IsTheSumOfItsWaves) {
  const JointVector one = JointVector::Ones(1), none = JointVector::Zero(1);
  const Cogging cogging{{{0.6 * one, one, none}, {0.2 * one, one / 3.0, none}}};
  EXPECT_NEAR(cogging.at(0.15 * one)[0], 2.0 / 3.0, 1e-15);
}

TEST(Cogging, HasAKeyForEachWave) {
  EXPECT_EQ(cogging_key(0), "cogging_");
  EXPECT_EQ(cogging_key(1), "cogging2_");
}

TEST(Cogging, IsOfAllDrivesOrOfNone) {
  EXPECT_TRUE(Cogging().is_none());
  EXPECT_TRUE(problems(Cogging(), 3).empty());
  EXPECT_TRUE(problems(some(), 2).empty());
  EXPECT_EQ(problems(some(), 3).size(), 1U);
  Cogging cogging = some();
  cogging.waves.push_back(cogging.waves[0]);
  EXPECT_TRUE(problems(cogging, 2).empty());
  cogging.waves[1].wavelength[1] = 0.0;
  cogging.waves[1].sine[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(problems(cogging, 2).size(), 2U);
}

}  // namespace
}  // namespace flinch
