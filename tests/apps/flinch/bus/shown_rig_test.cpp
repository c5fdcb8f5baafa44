// flinch serve --live: a rig on the bus in a browser, while a controller runs it, twice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "tests/apps/flinch/bus/lockstep_rig.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::OtherProgram;
using test::Outcome;
using test::RigOnTheBus;
using ::testing::HasSubstr;

#if FLINCH_HAS_LIVE_VIEW

/// The address that the program says.
std::string address_of(const OtherProgram& program) {
  const std::string said = program.output();
  const std::size_t begin = said.find("http://");
  return said.substr(begin, said.find('\n', begin) - begin);
}

TEST(ServedRig, IsSeenInABrowserRunByRun) {
  const RigOnTheBus rig("platform_collision", {"--lockstep", "--patience", "120", "--live", "--json"});
  ASSERT_TRUE(rig.server->writes("live: http://127.0.0.1", 120s));
  const std::filesystem::path ready = rig.place / "ready";
  OtherProgram browser(
      {.command = {"/usr/bin/python3", FLINCH_SOURCE_DIR "/tests/experiments/live_view/bench_in_browser.py",
                   address_of(*rig.server), ready.string()},
       .environment = {},
       .preloaded = "",
       .prepare = {}});
  while (!std::filesystem::exists(ready) && browser.is_running())
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  std::optional<int> status;
  for (int runs = 0; runs < 20 && !status; ++runs) {
    std::vector<std::string> run = rig.run_arguments();
    run.insert(run.end(), {"--lockstep", "--patience", "120", "--json"});
    const Outcome outcome = test::flinch(run);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    status = browser.wait(1s);
  }
  if (status == 77) GTEST_SKIP() << "there is no chromedriver";
  EXPECT_EQ(status, 0) << browser.output();
  rig.server->interrupt();
  EXPECT_EQ(rig.server->wait(60s), 0);
  EXPECT_THAT(rig.server->output(), HasSubstr("\"pace\""));
}

#else

TEST(ServedRig, SaysWhatABrowserNeeds) {
  const Outcome outcome = test::flinch({"serve", "platform_collision", "--live", "--duration", "1"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("cpp-httplib"));
}

#endif

}  // namespace
}  // namespace flinch
