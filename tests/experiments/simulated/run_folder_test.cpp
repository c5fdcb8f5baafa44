#include "experiments/report/run_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

TEST(RunFolder, HoldsTheRecordingAndItsReport) {
  const test::Workplace place;
  const std::filesystem::path folder = place / "out/of/runs";
  const RunFolder own = make_run_folder(folder);
  const SimulatedScenario scenario = read_simulated_scenario(place / "scenarios/platform_collision.yaml");
  const Verdict verdict = conclude_run(scenario, run_experiment(scenario), folder);
  EXPECT_TRUE(verdict.good()) << verdict.failures.front();
  EXPECT_EQ(verdict.contacts.size(), 1U);
  EXPECT_EQ(read_recording(folder / "run.h5").samples(), 1200U);
  EXPECT_THAT(test::bytes_of(folder / "report.html"), ::testing::HasSubstr("</html>"));
}

TEST(RunFolder, BelongsToOneRunAtATime) {
  const test::Workplace place;
  {
    const RunFolder first = make_run_folder(place / "out");
    try {
      const RunFolder second = make_run_folder(place / "out");
      ADD_FAILURE() << "two runs have it";
    } catch (const SetupError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("the process " + std::to_string(::getpid())));
    }
  }
  EXPECT_NO_THROW((void)make_run_folder(place / "out"));
}

TEST(RunFolder, StaysBelowOutWhateverTheNameOfARun) {
  EXPECT_EQ(default_folder("square"), "out/square");
  EXPECT_EQ(default_folder(".hidden"), "out/.hidden");
  for (const char* const name : {"", ".", "..", "/etc", "a/b", "../../a", "a/"}) {
    EXPECT_THROW((void)default_folder(name), SetupError) << name;
  }
}

TEST(RunFolder, CannotBeWhereAFileIs) {
  const test::Workplace place;
  place.write("out", "a file");
  try {
    const RunFolder folder = make_run_folder(place / "out/run");
    ADD_FAILURE() << "it was made";
  } catch (const SetupError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("out/run: the folder cannot be made: "));
  }
}

}  // namespace
}  // namespace flinch
