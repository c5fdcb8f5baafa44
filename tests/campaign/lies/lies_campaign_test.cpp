// The whole campaign of lies, and how near honest robots come to be called liars. FLINCH_LIES_RUNS: share of it.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/fault/lies/false_alarms.h"

namespace flinch::test {
namespace {

std::size_t runs(std::size_t all) {
  const char* const share = std::getenv("FLINCH_LIES_SHARE");
  return share == nullptr ? all : static_cast<std::size_t>(std::atof(share) * static_cast<double>(all));
}

class FalseAlarms : public testing::TestWithParam<MountedSensors> {};

INSTANTIATE_TEST_SUITE_P(Sensors, FalseAlarms,
                         testing::Values(MountedSensors{}, MountedSensors{.passive_encoders = false},
                                         MountedSensors{.imu = false},
                                         MountedSensors{.passive_encoders = false, .imu = false}),
                         [](const auto& mounted) {
                           return std::string(mounted.param.passive_encoders ? "With" : "Without") +
                                  "PassiveEncoders" + (mounted.param.imu ? "With" : "Without") + "Imu";
                         });

TEST_P(FalseAlarms, AreNoneInThreeHoursOfDynamicMotion) {
  const Margins margins =
      margins_of_campaign(FLINCH_SOURCE_DIR "/tests/campaign/lies/motion.yaml", runs(310), GetParam());
  fmt::print("motion: {}", margins.table());
  EXPECT_TRUE(margins.alarms.empty());
}

TEST_P(FalseAlarms, AreNoneInThreeThousandContacts) {
  const Margins margins =
      margins_of_campaign(FLINCH_SOURCE_DIR "/tests/campaign/lies/contacts.yaml", runs(3200), GetParam());
  fmt::print("contacts: {}", margins.table());
  EXPECT_TRUE(margins.alarms.empty());
}

}  // namespace
}  // namespace flinch::test
