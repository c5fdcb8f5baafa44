// Results in folders that others use, own or have prepared.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/campaign/interrupted/verb_results.h"
#include "tests/support/flinch_program.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;
using test::InterruptedVerb;
using test::OtherProgram;
using test::VerbResults;

class Places : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  VerbResults results_{folder_.path()};
};

TEST_F(Places, ThatTwoRunsWantBelongToTheFirst) {
  const InterruptedVerb verb = results_.run();
  results_.make_both(verb);
  for (int pair = 0; pair < 6; ++pair) {
    OtherProgram one(test::flinch_program(verb.newer)), other(test::flinch_program(verb.newer));
    const int first = one.wait(100s).value_or(-1), second = other.wait(100s).value_or(-1);
    EXPECT_TRUE(first == 0 || second == 0) << one.output() << other.output();
    for (const auto& [status, said] : {std::pair(first, one.output()), std::pair(second, other.output())}) {
      if (status == 0) continue;  // both, where one began after the other's end
      EXPECT_EQ(status, 2);
      EXPECT_NE(said.find("writes its results there"), std::string::npos) << said;
    }
    results_.expect_one_of_both();
  }
  results_.make_older(verb);
}

TEST_F(Places, OfSomebodyElseAreLeftAsTheyAre) {
  if (::getuid() != 0) GTEST_SKIP() << "needs to become another user";
  const InterruptedVerb verb = results_.run();
  results_.make_both(verb);
  const test::Files before = results_.files();
  ASSERT_EQ(::chmod(results_.folder().c_str(), 0755), 0);
  OtherProgram::Start start = test::flinch_program(verb.newer);
  start.prepare = [] { return ::setgid(65534) == 0 && ::setuid(65534) == 0; };
  OtherProgram program(start);
  EXPECT_EQ(program.wait(100s), 2);
  EXPECT_NE(program.output().find("Permission denied"), std::string::npos) << program.output();
  EXPECT_EQ(results_.files(), before);
}

TEST_F(Places, WithSymbolicLinksLoseNothingThatTheseLeadTo) {
  const fs::path precious = results_.file("precious");
  std::ofstream(precious) << "precious";
  for (const char* const name : {"run.h5", "run.h5.part", "report.html", "results.part.new", "results.csv",
                                 "results.h5", "campaign.html", "found.yaml"}) {
    fs::create_symlink(precious, results_.file(name));
  }
  for (const InterruptedVerb& verb : {results_.run(), results_.campaign(), results_.calibrate()}) {
    OtherProgram program(test::flinch_program(verb.newer));
    EXPECT_EQ(program.wait(100s), 0) << program.output();
    EXPECT_TRUE(test::bytes_of(precious) == "precious") << verb.newer.front();
  }
  for (const auto& entry : fs::directory_iterator(results_.folder()))
    EXPECT_FALSE(fs::is_symlink(entry.symlink_status())) << entry.path();
}

}  // namespace
}  // namespace flinch
