// flinch demo, and the files that come with flinch by their names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/flinch/program.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using test::flinch;
using test::Outcome;
using ::testing::HasSubstr;

class Demo : public ::testing::Test {
 protected:
  std::string at(const std::string& name) const { return (folder_ / name).string(); }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(Demo, ShowsTheBestBesideThePapersSetUp) {
  const Outcome outcome = flinch({"demo", "--out", at("demo")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("fused detector"));
  EXPECT_THAT(outcome.out, HasSubstr("the papers' set-up"));
  EXPECT_TRUE(std::filesystem::exists(at("demo/report.html")));
  EXPECT_TRUE(std::filesystem::exists(at("demo/papers/report.html")));
}

TEST_F(Demo, PrintsTheVerdictOfTheBestAsJson) {
  const Outcome outcome = flinch({"demo", "--json", "--out", at("demo")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["verdict"], "good");
}

TEST_F(Demo, ScenariosThatComeWithFlinchAreRunByTheirName) {
  const Outcome outcome =
      flinch({"run", "square", "--set", "duration_s=0.5", "--json", "--out", at("square")});
  EXPECT_THAT(outcome.out, HasSubstr("\"verdict\"")) << outcome.err;
  const Outcome unknown = flinch({"run", "no_such_scenario"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("no_such_scenario: no such file"));
}

}  // namespace
}  // namespace flinch
