#include "experiments/live/live_experiment.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "experiments/recorded/recorded_signals.h"
#include "experiments/scenario/scenario.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

Scenario shipped_scenario() {
  return read_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/platform_collision.yaml");
}

bool is_recorded(const Diagram& diagram, const std::string& path) {
  const std::vector<std::string> paths = recorded_paths(diagram);
  return std::find(paths.begin(), paths.end(), path) != paths.end();
}

TEST(LiveExperiment, AsksNobodyWhatTouchesTheRobot) {
  const LiveExperiment experiment = build_live_experiment(shipped_scenario());
  EXPECT_FALSE(experiment.told_classification || experiment.told_location);
  EXPECT_FALSE(is_recorded(*experiment.diagram, "told_classification")) << "a replay would go by it";
}

TEST(LiveExperiment, IsResetByNoList) {
  const Scenario scenario = read_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/brought_back.yaml");
  const auto problems = test::problems_of([&] { build_live_experiment(scenario); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.front().find("'operator' resets and starts the robot though nobody sees"), 0U);
}

TEST(LiveExperiment, FollowsItsOperatorsListWhereTheRobotIsSimulatedAndWaits) {
  const Scenario scenario = read_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/brought_back.yaml");
  const LiveExperiment experiment = build_live_experiment(scenario, RobotOutside::lockstep);
  EXPECT_TRUE(is_recorded(*experiment.diagram, "operator"));
  EXPECT_TRUE(is_recorded(*experiment.diagram, "panel")) << "beside which somebody may press buttons";
}

TEST(LiveExperiment, CanBeToldWhatTouchesTheRobotAndRecordsIt) {
  Scenario scenario = shipped_scenario();
  scenario.control.contact_is_told = true;
  const LiveExperiment experiment = build_live_experiment(scenario);
  const std::string acted_upon = "control/told_contact/";
  Recorder recorder(
      *experiment.diagram,
      {"told_classification", "told_location", acted_upon + "classification", acted_upon + "location"}, 1);
  Simulator simulator(*experiment.diagram);
  simulator.record(recorder);
  Context context = experiment.diagram->make_context();
  const ContactClassification clamped{.valid = true, .accepted = true, .most_likely = 8, .probability = {}};
  ContactLocation there;
  there.valid = true;
  there.fraction = 0.25;
  context.set(experiment.told_classification.value(), clamped);
  context.set(experiment.told_location.value(), there);
  simulator.step(context);
  const Recording recording = recorder.recording();
  for (const std::string& path : {std::string("told_"), acted_upon}) {
    EXPECT_EQ(read<ContactClassification>(recording, path + "classification")[0].most_likely, 8) << path;
    EXPECT_EQ(read<ContactLocation>(recording, path + "location")[0].fraction, 0.25) << path;
  }
}

}  // namespace
}  // namespace flinch
