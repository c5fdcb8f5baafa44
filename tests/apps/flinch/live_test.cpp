// flinch run --live, as far as nobody looks: what a browser sees is tested with the library.
#include <gmock/gmock.h>

#include <cstring>
#include <string>

#include "systems/framework/recording.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::flinch;
using test::Outcome;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

class RunInABrowser : public ::testing::Test {
 protected:
  Outcome run(std::vector<std::string> more) const {
    more.insert(more.begin(), {"run", place.at("scenarios/platform_collision.yaml"), "--out", place.at("out"),
                               "--set", "duration_s=0.7"});
    return flinch(more);
  }

  test::Workplace place;
};

constexpr const char* address = "live: http://127\\.0\\.0\\.1:[0-9]+/[0-9a-f]+/\n";

#if FLINCH_HAS_LIVE_VIEW

TEST_F(RunInABrowser, PrintsItsAddressWhateverElseIsSilent) {
  for (const char* const silence : {"--quiet", "--json"}) {
    const Outcome outcome = run({"--live", "--live-wait", "0", "--live-speed", "100", silence});
    EXPECT_THAT(outcome.err, ContainsRegex(address)) << silence;
    EXPECT_THAT(outcome.err, Not(HasSubstr("simulation begins"))) << silence;
  }
}

TEST_F(RunInABrowser, SaysForWhatItWaits) {
  const Outcome outcome = run({"--live", "--live-wait", "0.2", "--live-speed", "100"});
  EXPECT_THAT(outcome.err,
              HasSubstr("the simulation begins when that is open in a browser, or after 0.2 s\n"));
}

TEST_F(RunInABrowser, EndsAsARunThatNobodyWatches) {
  const Outcome plain = run({"--json"});
  const Recording alone = read_recording(place / "out/run.h5");
  const Outcome shown = run({"--json", "--live", "--live-wait", "0", "--live-speed", "100"});
  const Recording watched = read_recording(place / "out/run.h5");
  EXPECT_EQ(shown.status, plain.status);
  EXPECT_EQ(watched.time_ns, alone.time_ns);
  for (const Signal& signal : alone.signals) {
    const std::vector<internal::Number>& rows = watched.signal(signal.path).rows;
    ASSERT_EQ(rows.size(), signal.rows.size());
    EXPECT_EQ(std::memcmp(rows.data(), signal.rows.data(), rows.size() * sizeof rows[0]), 0) << signal.path;
  }
}

#else

TEST_F(RunInABrowser, SaysThatThisProgramCannot) {
  const Outcome outcome = run({"--live"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--live: this flinch was built without cpp-httplib"));
}

#endif

}  // namespace
}  // namespace flinch
