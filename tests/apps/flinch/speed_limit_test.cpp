// flinch speed-limit, as typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "systems/foundation/html_page.h"
#include "tests/apps/flinch/documented_keys.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::flinch;
using test::Outcome;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SpeedLimitVerb : public ::testing::Test {
 protected:
  /// One place, few speeds, and a share that few runs can show.
  Outcome speed_limit(std::vector<std::string> options) const {
    const std::vector<std::string> usual = {"speed-limit", "platform_collision",
                                            "--at",        "-0.04,0",
                                            "--towards",   "180",
                                            "--share",     "0.3",
                                            "--step",      "0.3",
                                            "--body",      "platform",
                                            "--out",       place.at("out")};
    options.insert(options.begin(), usual.begin(), usual.end());
    return flinch(options);
  }

  test::Workplace place;
};

TEST_F(SpeedLimitVerb, AnswersInATableAndASentenceAndLeavesAMap) {
  const Outcome outcome = speed_limit({});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("platform        x m      y m      180 deg\n"));
  EXPECT_THAT(outcome.out, HasSubstr("m/s fewer than 30 % of contacts exceed 280 N, or 140 N after 0.5 s"));
  EXPECT_THAT(outcome.err, HasSubstr("speed_limit.html"));
  for (const char* name :
       {"out/speed_limit.html", "out/speed_limit.json", "out/results.csv", "out/results.h5"})
    EXPECT_FALSE(test::bytes_of(place / name).empty()) << name;
  // The folder knows what is done: the same call does nothing, another is refused.
  const Outcome again = speed_limit({"--json"});
  EXPECT_EQ(again.out, test::bytes_of(place / "out/speed_limit.json"));
  const Outcome other = speed_limit({"--region", "face"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("--fresh"));
}

TEST_F(SpeedLimitVerb, PrintsTheKeysThatTheDocumentNames) {
  const auto json = nlohmann::json::parse(speed_limit({"--json"}).out);
  ASSERT_EQ(json.size(), 2U);
  ASSERT_EQ(json["cells"].size(), 1U);
  EXPECT_EQ(json["cells"][0].size(), 6U);
  EXPECT_THAT(test::undocumented_keys(json, "Limit speeds"), IsEmpty());
}

}  // namespace
}  // namespace flinch
