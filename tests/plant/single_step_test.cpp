#include "plant/single_step.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace flinch {
namespace {

/// x'' = -x, and how often it was asked.
class Pendulum final : public DifferentialEquation {
 public:
  void rates(double, std::span<const double> y, std::span<double> rates) override {
    ++asked;
    rates[0] = y[1];
    rates[1] = -y[0];
  }
  int asked = 0;
};

/// Heun's method, of second order, with Euler's, of first, in it.
ButcherTable heun() { return {.A = {{}, {1.0}}, .b = {0.5, 0.5}, .c = {0.0, 1.0}, .error = {-0.5, 0.5}}; }

TEST(SingleStep, IsThatOfItsTable) {
  Pendulum pendulum;
  SingleStep step(heun(), 2);
  const double h = 0.25;
  step.take(pendulum, h, std::array{1.0, 2.0});
  std::array<double, 2> end{};
  step.write(end);
  EXPECT_EQ(pendulum.asked, 2);
  EXPECT_DOUBLE_EQ(end[0], 1.0 + 2.0 * h - 0.5 * h * h);
  EXPECT_DOUBLE_EQ(end[1], 2.0 - h - 0.5 * 2.0 * h * h);
}

TEST(SingleStep, TellsTheWeighedErrorOfTheMethodInIt) {
  Pendulum pendulum;
  SingleStep step(heun(), 2);
  const double h = 0.25;
  step.take(pendulum, h, std::array{1.0, 2.0});
  const double of_position = -0.5 * h * h, of_velocity = -0.5 * 2.0 * h * h;
  EXPECT_DOUBLE_EQ(step.error(std::array{1.0, 0.0}), std::abs(of_position) / std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(step.error(std::array{1.0, 10.0}),
                   std::sqrt((of_position * of_position + 100.0 * of_velocity * of_velocity) / 2.0));
}

TEST(SingleStep, KnowsTheRatesOfItsStagesAndNoOthers) {
  Pendulum pendulum;
  SingleStep step(heun(), 2);
  step.take(pendulum, 0.25, std::array{1.0, 2.0});
  const auto known = step.known_rates(0.25, std::array{1.5, 1.75});
  ASSERT_EQ(known.size(), 2U);
  EXPECT_EQ(known[0], 1.75);
  EXPECT_EQ(known[1], -1.5);
  EXPECT_TRUE(step.known_rates(0.25, std::array{1.5, 1.7}).empty());
  EXPECT_TRUE(step.known_rates(0.2, std::array{1.5, 1.75}).empty());
}

TEST(SingleStep, SumsAsManyStatesAsThereAre) {
  class Growth final : public DifferentialEquation {
   public:
    void rates(double, std::span<const double> y, std::span<double> rates) override {
      for (std::size_t i = 0; i < y.size(); ++i) rates[i] = static_cast<double>(i);
    }
  } growth;
  for (const std::size_t size : {1U, 5U, 6U, 7U, 13U}) {
    SingleStep step(heun(), size);
    std::vector<double> y(size, 1.0);
    step.take(growth, 2.0, y);
    step.write(y);
    for (std::size_t i = 0; i < size; ++i) EXPECT_EQ(y[i], 1.0 + 2.0 * static_cast<double>(i));
  }
}

}  // namespace
}  // namespace flinch
