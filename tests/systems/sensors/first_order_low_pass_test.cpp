#include "systems/sensors/first_order_low_pass.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "systems/framework/random.h"

namespace flinch {
namespace {

constexpr double w = 2.0 * std::numbers::pi * 30.0;

JointVector random_vector(RandomGenerator& random) {
  return JointVector::NullaryExpr(3, [&] { return random.uniform(-1.0, 1.0); });
}

class LowPassOfEitherForm : public testing::TestWithParam<LowPassForm> {
 protected:
  const FirstOrderLowPass low_pass_{LowPassSettings{30.0, GetParam()}};
};
INSTANTIATE_TEST_SUITE_P(FirstOrderLowPass, LowPassOfEitherForm,
                         testing::Values(LowPassForm::tustin, LowPassForm::backward_difference));

TEST_P(LowPassOfEitherForm, LetsAConstantThroughFromTheFirstInterval) {
  const JointVector constant{{1.0, -2.0, 3.0}};
  LowPassMemory memory;
  for (int k = 0; k < 50; ++k) {
    memory = low_pass_.next(memory, constant, 1e-3);
    ASSERT_LT((memory.output - constant).norm(), 1e-14);
  }
}

TEST_P(LowPassOfEitherForm, IsLinear) {
  RandomGenerator random(1);
  LowPassMemory a;
  LowPassMemory b;
  LowPassMemory sum;
  for (int k = 0; k < 200; ++k) {
    const JointVector mean_a = random_vector(random);
    const JointVector mean_b = random_vector(random);
    a = low_pass_.next(a, mean_a, 1e-3);
    b = low_pass_.next(b, mean_b, 1e-3);
    sum = low_pass_.next(sum, mean_a - 2.0 * mean_b, 1e-3);
    ASSERT_LT((sum.output - (a.output - 2.0 * b.output)).norm(), 1e-13);
  }
}

// A step decays by the pole (2 - w T) / (2 + w T) in each interval, which for small w T is exp(-w T).
TEST_P(LowPassOfEitherForm, ForgetsWithTheTimeConstantOfTheContinuousFilter) {
  const JointVector one = JointVector::Ones(3);
  const JointVector zero = JointVector::Zero(3);
  LowPassMemory memory = low_pass_.next({}, one, 1e-5);
  for (int k = 0; k < 1000; ++k) memory = low_pass_.next(memory, zero, 1e-5);
  EXPECT_NEAR(memory.output[0], std::exp(-w * 1e-2), 1e-2 * std::exp(-w * 1e-2));
}

// v_k = [2 w (q_k - q_{k-1}) + (2 - w T) v_{k-1}] / (2 + w T)
TEST(FirstOrderLowPass, IsTheBilinearTransformOfTheDifferentiatingLowPass) {
  constexpr double T = 1e-3;
  const FirstOrderLowPass low_pass({30.0, LowPassForm::tustin});
  RandomGenerator random(2);
  JointVector q = random_vector(random);
  LowPassMemory memory = low_pass.next({}, JointVector::Zero(3), T);
  JointVector v = JointVector::Zero(3);
  for (int k = 0; k < 200; ++k) {
    const JointVector next = random_vector(random);
    v = (2.0 * w * (next - q) + (2.0 - w * T) * v) / (2.0 + w * T);
    memory = low_pass.next(memory, (next - q) / T, T);
    q = next;
    ASSERT_LT((memory.output - v).norm(), 1e-11);
  }
}

// v_k = [d_k + d_{k-1} + (c - 1) v_{k-1}] / (c + 1), d_k = (q_k - q_{k-1}) / T, c = 2 / (w T)
TEST(FirstOrderLowPass, IsTheBilinearLowPassOfABackwardDifference) {
  constexpr double T = 1e-3;
  constexpr double c = 2.0 / (w * T);
  const FirstOrderLowPass low_pass({30.0, LowPassForm::backward_difference});
  RandomGenerator random(3);
  LowPassMemory memory = low_pass.next({}, JointVector::Zero(3), T);
  JointVector v = JointVector::Zero(3);
  JointVector d = JointVector::Zero(3);
  for (int k = 0; k < 200; ++k) {
    const JointVector next = 1000.0 * random_vector(random);
    v = (next + d + (c - 1.0) * v) / (c + 1.0);
    memory = low_pass.next(memory, next, T);
    d = next;
    ASSERT_LT((memory.output - v).norm(), 1e-11);
  }
}

TEST(FirstOrderLowPass, AsksForAPositiveFrequency) {
  EXPECT_TRUE(problems(LowPassSettings{}).empty());
  for (const double frequency : {0.0, -30.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(problems(LowPassSettings{frequency, LowPassForm::tustin}).size(), 1U) << frequency;
  }
}

}  // namespace
}  // namespace flinch
