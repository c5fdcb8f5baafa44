// flinch keys; that the keys are good ones is tested with the drivers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/flinch/documented_keys.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class Keys : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!FLINCH_HAS_BUS) GTEST_SKIP() << "built without the drivers";
  }
  test::Outcome keys(std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"keys", place.at("keys")});
    return test::flinch(options);
  }
  std::string key() const { return test::bytes_of(place / "keys/robot/private_key.pem"); }

  test::Workplace place;
};

TEST_F(Keys, AreMadeForEachRole) {
  const test::Outcome outcome = keys();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(StartsWith("keys: " + place.at("keys")), HasSubstr("good until 2")));
  EXPECT_THAT(outcome.err, HasSubstr("only the subfolder"));
  for (const std::string role : {"controller", "robot", "observer"}) {
    EXPECT_TRUE(std::filesystem::is_regular_file(place / ("keys/" + role + "/permissions.p7s"))) << role;
  }
}

TEST_F(Keys, AreToldInJsonOrNotAtAll) {
  const auto told = nlohmann::json::parse(keys({"--json", "--days", "10"}).out);
  EXPECT_EQ(told["keys"]["robot"], place.at("keys/robot"));
  EXPECT_THAT(test::undocumented_keys(told, "JSON"), IsEmpty());
  EXPECT_EQ(told["good_until"].get<std::string>().size(), 10u);
  const test::Outcome quiet = keys({"--quiet", "--force"});
  EXPECT_EQ(quiet.status, 0);
  EXPECT_THAT(quiet.out + quiet.err, IsEmpty());
}

TEST_F(Keys, AreForTheDomainAskedFor) {
  EXPECT_EQ(keys({"--domain", "7"}).status, 0);
  EXPECT_THAT(test::bytes_of(place / "keys/robot/governance.p7s"), HasSubstr("<min>7</min><max>7</max>"));
}

TEST_F(Keys, AreReplacedOnlyByForce) {
  keys();
  const std::string first = key();
  const test::Outcome refused = keys();
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("--force"));
  EXPECT_EQ(key(), first);
  EXPECT_EQ(keys({"--force"}).status, 0);
  EXPECT_NE(key(), first);
}

TEST_F(Keys, AreRefusedForADurationOrDomainThatIsNone) {
  EXPECT_EQ(keys({"--days", "0"}).status, 2);
  EXPECT_EQ(keys({"--domain", "231"}).status, 2);
  EXPECT_EQ(test::flinch({"keys"}).status, 2);
  EXPECT_FALSE(std::filesystem::exists(place / "keys"));
}

}  // namespace
}  // namespace flinch
