#include "experiments/report/run_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  make_run_folder(folder);
  const SimulatedScenario scenario = read_simulated_scenario(place / "scenarios/platform_collision.yaml");
  const Verdict verdict = conclude_run(scenario, run_experiment(scenario), folder);
  EXPECT_TRUE(verdict.good()) << verdict.failures.front();
  EXPECT_EQ(verdict.contacts.size(), 1U);
  EXPECT_EQ(read_recording(folder / "run.h5").samples(), 1200U);
  EXPECT_THAT(test::bytes_of(folder / "report.html"), ::testing::HasSubstr("</html>"));
}

TEST(RunFolder, CannotBeWhereAFileIs) {
  const test::Workplace place;
  place.write("out", "a file");
  try {
    make_run_folder(place / "out/run");
    ADD_FAILURE() << "it was made";
  } catch (const SetupError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("out/run: the folder cannot be made: "));
  }
}

}  // namespace
}  // namespace flinch
