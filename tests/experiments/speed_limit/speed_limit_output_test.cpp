#include "experiments/speed_limit/speed_limit_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/experiments/speed_limit/sample_limits.h"

namespace flinch {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Bound = FoundSpeed::Bound;

class SpeedLimitOutput : public ::testing::Test, protected test::SampleLimits {
 protected:
  std::string sentence() const { return speed_limit_sentence(study, limits); }
};

TEST_F(SpeedLimitOutput, IsAnsweredByTheLowestLimitThatAForceSets) {
  EXPECT_EQ(sentence(),
            "Up to 0.434 m/s fewer than 10 % of contacts exceed 280 N, or 140 N after 0.5 s (hand and "
            "fingers), with a confidence of 95 % in each cell; lowest is link1 at x = -0.100 m, y = 0.000 m, "
            "moving towards 0 degrees; 2 cells are not tested up to that speed; in 1 of 8 cells nothing can "
            "be run into.");
}

TEST_F(SpeedLimitOutput, SaysWhereEvenTheSlowestSpeedIsTooFast) {
  limits[3].found = FoundSpeed{std::nullopt, Bound::force, 1, 0};
  EXPECT_THAT(sentence(), StartsWith("Not even at 0.1 m/s is it shown that fewer than 10 % of contacts"));
  EXPECT_EQ(json::parse(speed_limit_json(study, limits))["cells"][3]["speed_m_per_s"], 0.0);
}

TEST_F(SpeedLimitOutput, SaysWhereNoForceSetsALimit) {
  limits.resize(4);
  limits.erase(limits.begin(), limits.begin() + 2);
  EXPECT_THAT(sentence(),
              StartsWith("At all speeds that could be tried, up to 0.3 m/s and more, fewer than"));
  limits.clear();
  EXPECT_EQ(sentence(), "Nothing is known: in none of 0 cells the robot runs into the obstacle.");
}

TEST_F(SpeedLimitOutput, HasARowForEachBodyAndPlace) {
  const std::string table = speed_limit_table(study, limits);
  EXPECT_THAT(table, HasSubstr("Platform collision: limit speeds in m/s, 37 contacts of each cell"));
  EXPECT_THAT(table, HasSubstr("\nplatform        x m      y m        0      90 deg\n"
                               "             -0.100    0.000    0.812 >=0.300\n"
                               "              0.100    0.025    1.234       -\n"));
  EXPECT_THAT(table, HasSubstr("\nlink1           x m      y m        0      90 deg\n"
                               "             -0.100    0.000    0.434 >=2.000\n"
                               "              0.100    0.025        -   0.600\n"));
  EXPECT_THAT(table, HasSubstr(sentence()));
}

TEST_F(SpeedLimitOutput, IsOneObjectOfJson) {
  const json printed = json::parse(speed_limit_json(study, limits));
  EXPECT_EQ(printed.size(), 2U);
  EXPECT_EQ(printed["summary"], sentence());
  ASSERT_EQ(printed["cells"].size(), 8U);
  EXPECT_EQ(printed["cells"][0], json({{"x_m", -0.1},
                                       {"y_m", 0.0},
                                       {"direction_deg", 0.0},
                                       {"body", "platform"},
                                       {"speed_m_per_s", 0.812},
                                       {"confidence", 0.9528}}));
  for (const std::size_t untested : {5U, 6U}) {
    EXPECT_TRUE(printed["cells"][untested]["speed_m_per_s"].is_null());
    EXPECT_TRUE(printed["cells"][untested]["confidence"].is_null());
  }
}

}  // namespace
}  // namespace flinch
