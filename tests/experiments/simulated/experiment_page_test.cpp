#include <gtest/gtest.h>
#include <unistd.h>

#include "experiments/report/experiment_report.h"
#include "experiments/report/report_page.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "systems/framework/recording.h"
#include "tests/experiments/report/chromium.h"

namespace flinch {
namespace {

Report report_of(const std::string& scenario_file) {
  const SimulatedScenario scenario = read_simulated_scenario(scenario_file);
  const Recording recording = run_experiment(scenario, {{"command_line", "flinch run " + scenario_file}});
  return experiment_report(scenario, recording, judge(recording, scenario.expected, scenario.force_limits));
}

TEST(ExperimentPage, WorksInChromium) {
  const std::filesystem::path page =
      std::filesystem::temp_directory_path() / ("flinch_experiment_" + std::to_string(getpid()) + ".html");
  write_report_page(report_of(FLINCH_SOURCE_DIR "/apps/scenarios/platform_collision.yaml"), page);
  expect_works_in_chromium(page);
  std::filesystem::remove(page);
}

/// Every scenario that ships has a page that the check of its names and lengths lets pass.
TEST(ExperimentPage, FitsEveryScenario) {
  for (const auto& entry : std::filesystem::directory_iterator(FLINCH_SOURCE_DIR "/apps/scenarios")) {
    const Report report = report_of(entry.path().string());
    check_report(report);
    EXPECT_TRUE(report.good) << entry.path();
    EXPECT_EQ(report.contacts.empty(), report.obstacles.empty()) << entry.path();
  }
}

}  // namespace
}  // namespace flinch
