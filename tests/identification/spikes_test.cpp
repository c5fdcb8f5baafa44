#include "identification/spikes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/framework/random.h"

namespace flinch {
namespace {

Eigen::MatrixXd wave(double noise) {
  RandomGenerator random(1);
  Eigen::MatrixXd x(2000, 1);
  for (int k = 0; k < 2000; ++k) x(k, 0) = 10.0 * std::sin(0.02 * k) + noise * random.normal();
  return x;
}

TEST(Spikes, AreReplacedAndTheRestIsLeftAsItWas) {
  const Eigen::MatrixXd clean = wave(0.1);
  Eigen::MatrixXd x = clean;
  for (int k = 7; k < 2000; k += 10) x(k, 0) += 40.0;
  EXPECT_GE(remove_spikes(x), 199U);
  for (int k = 0; k < 2000; ++k) EXPECT_NEAR(x(k, 0), clean(k, 0), k % 10 == 7 ? 1.2 : 0.7) << k;
}

TEST(Spikes, AreHardlyFoundInNoiseAlone) {
  Eigen::MatrixXd x = wave(0.1);
  EXPECT_LT(remove_spikes(x), 20U);
}

TEST(Spikes, AreNotFoundInWhatIsSmooth) {
  Eigen::MatrixXd x = wave(0.0);
  const Eigen::MatrixXd before = x;
  EXPECT_EQ(remove_spikes(x), 0U);
  EXPECT_EQ(x, before);
}

}  // namespace
}  // namespace flinch
