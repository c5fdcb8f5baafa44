// What the program makes of the recording of a run that was killed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <thread>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/framework/recording.h"
#include "systems/framework/recording_journal.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/other_program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::flinch;
using test::Outcome;
using ::testing::HasSubstr;

/// A collision after 0.4 s, whose run was killed when 70 % of its 1.2 s were done.
class KilledRun : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(place / "killed");
    test::OtherProgram run([this] {
      const SimulatedScenario scenario = read_simulated_scenario(place / "scenarios/platform_collision.yaml");
      record_experiment(scenario, recording(), {}, [](double share) {
        if (share < 0.7) return;
        std::this_thread::sleep_for(500ms);  // what is recorded reaches the file every tenth of a second
        std::raise(SIGKILL);
      });
    });
    EXPECT_FALSE(run.wait(60s).has_value()) << "it ended by itself";
    ASSERT_FALSE(std::filesystem::exists(recording()));
    ASSERT_TRUE(std::filesystem::exists(part()));
  }

  std::filesystem::path recording() const { return place / "killed/run.h5"; }
  std::filesystem::path part() const { return part_name(recording()); }

  test::Workplace place;
};

constexpr const char* said = "partial:   the run was killed; only its first 0.";

TEST_F(KilledRun, IsReportedUpToItsLastMoment) {
  for (const std::filesystem::path& file : {part(), recording()}) {
    const Outcome outcome = flinch({"report", file.string(), "--out", place.at("page.html")});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(said));
    const std::string page = test::bytes_of(place / "page.html");
    for (const char* const told :
         {"\"recording.partial\"", "\"remarks\":[\"the run was killed; only its first 0.",
          "\"body\":\"platform\""}) {
      EXPECT_NE(page.find(told), std::string::npos) << told;
    }
    std::filesystem::remove(place / "page.html");
  }
}

TEST_F(KilledRun, IsAGoodRecordingToCheck) {
  for (const std::filesystem::path& file : {part(), recording()}) {
    const Outcome outcome = flinch({"check", file.string()});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out, file.string() + ": a good recording file\n");
    EXPECT_THAT(outcome.err, HasSubstr(said));
  }
}

TEST_F(KilledRun, IsReplayedBitForBitAsFarAsItGoes) {
  const Outcome outcome =
      flinch({"run", part().string(), "--station", "recorded", "--out", place.at("again")});
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(said));
  const Recording killed = open_recording(part());
  const Recording again = open_recording(place / "again/run.h5");
  EXPECT_EQ(again.time_ns, killed.time_ns);
  EXPECT_GT(again.samples(), 500U);
  for (const char* component : {"x", "y", "z"}) {
    const int i = component[0] - 'x';
    EXPECT_EQ(again.column("wrench", "wrench_in_base", i), killed.column("wrench", "wrench_in_base", i));
  }
}

TEST_F(KilledRun, IsNoRecordingWhereItsBeginningIsBroken) {
  const std::string bytes = test::bytes_of(part());
  place.write("killed/run.h5.part", bytes.substr(0, 20));
  for (const std::filesystem::path& file : {part(), recording()}) {
    const Outcome outcome = flinch({"report", file.string(), "--out", place.at("page.html")});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr("run.h5.part: this is no flinch recording: "));
    EXPECT_FALSE(std::filesystem::exists(place / "page.html"));
  }
}

}  // namespace
}  // namespace flinch
