#include "import/computed_columns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace flinch {
namespace {

constexpr double period = 0.01;  // [s]

double rounded(double value, double step) { return step * std::round(value / step); }

/// Two encoders of 0.01 rad that swing, with what else a log may hold of them.
class SwingingLog : public ::testing::Test {
 protected:
  SwingingLog() {
    for (int k = 0; k < 2000; ++k) {
      seconds.push_back(period * k);
      const double one = 0.5 * std::sin(2.0 * period * k), other = 0.3 * std::sin(3.1 * period * k);
      drives[0].values.push_back(rounded(one, 0.01));
      drives[1].values.push_back(rounded(other, 0.01));
    }
  }

  ColumnNumbers column(const std::string& name, const auto& value) const {
    ColumnNumbers made{name, {}};
    for (std::size_t k = 0; k < seconds.size(); ++k) made.values.push_back(value(k));
    return made;
  }
  /// "multiple of 'phi'", or "" where a column is told to be a sensor of its own.
  std::string told(const ColumnNumbers& candidate) const {
    const auto found = computed_columns(drives, {}, std::vector{candidate}, seconds);
    return found.empty() ? "" : found.front().words();
  }
  double q(std::size_t drive, std::size_t k) const { return drives[drive].values[k]; }

  std::vector<ColumnNumbers> drives = {{"phi", {}}, {"psi", {}}};
  std::vector<double> seconds;
};

TEST_F(SwingingLog, TellsAFunctionOfBothDrives) {
  EXPECT_EQ(told(column("x", [&](auto k) { return std::cos(q(0, k)) + 0.7 * std::sin(q(0, k) - q(1, k)); })),
            "a function of 'phi', 'psi'");
}

TEST_F(SwingingLog, TellsAnotherUnitOfOneDrive) {
  EXPECT_EQ(told(column("deg", [&](auto k) { return 57.29578 * q(1, k) - 12.0; })), "a multiple of 'psi'");
}

TEST_F(SwingingLog, TellsTheRateOfOneDrive) {
  const auto before = [&](std::size_t k) { return (q(0, k) - q(0, k - 1)) / period; };
  const auto around = [&](std::size_t k) { return (q(0, k + 1) - q(0, k - 1)) / (2.0 * period); };
  EXPECT_EQ(told(column("v", [&](auto k) { return k > 0 ? before(k) : NAN; })), "the rate of 'phi'");
  EXPECT_EQ(told(column("v", [&](auto k) { return k > 0 && k < 1999 ? around(k) : NAN; })),
            "the rate of 'phi'");
}

TEST_F(SwingingLog, TakesAnEncoderOfItsOwnForASensor) {
  // The same angle exactly, but rounded by another encoder, or shown with the least noise.
  const auto angle = [&](std::size_t k) { return 0.5 * std::sin(2.0 * period * static_cast<double>(k)); };
  EXPECT_EQ(told(column("own", [&](auto k) { return rounded(angle(k), 0.007); })), "");
  std::mt19937 generator(1);
  std::normal_distribution<double> noise(0.0, 1e-4);
  EXPECT_EQ(told(column("noisy", [&](auto k) { return std::cos(q(0, k)) + noise(generator); })), "");
}

TEST_F(SwingingLog, SaysNothingOfWhatHardlyChanges) {
  EXPECT_EQ(told(column("mode", [&](auto k) { return q(0, k) > 0.0 ? 1.0 : 0.0; })), "");
  EXPECT_EQ(told(column("constant", [&](auto) { return 3.0; })), "");
  EXPECT_EQ(told(column("empty", [&](auto) { return NAN; })), "");
}

TEST_F(SwingingLog, SaysNothingWhereTheDrivesNeverComeBack) {
  for (ColumnNumbers& drive : drives) {
    for (std::size_t k = 0; k < seconds.size(); ++k) drive.values[k] += 1e-6 * static_cast<double>(k);
  }
  EXPECT_EQ(told(column("x", [&](auto k) { return std::cos(q(0, k)) * q(1, k); })), "");
}

}  // namespace
}  // namespace flinch
