#include "experiments/scenario/scenario_tasks.h"

#include <gmock/gmock.h>

#include "diagrams/task_settings.h"
#include "systems/config/config_reader.h"
#include "systems/foundation/setup_error.h"
#include "tests/support/planar_bench.h"

namespace flinch {
namespace {

TaskSettings read(const std::string& text) {
  ConfigReader reader = ConfigReader::parse(text, "some.yaml");
  TaskSettings settings;
  read_tasks(reader, *test::planar_bench(), settings);
  reader.finish();
  return settings;
}

TEST(ScenarioTasks, WhatAFileLeavesOutStaysAsThePapersHaveIt) {
  const TaskSettings settings = read("tasks: {blend_ms: 20}");
  EXPECT_EQ(settings.blend, 20ms);
  EXPECT_EQ(settings.constraints.kept, ConstraintsKept::after_contact);
  EXPECT_EQ(settings.constraints.sigma_kappa.safety, 15.0);
  EXPECT_EQ(settings.reaction.platform.force[0], 2000.0);
}

TEST(ScenarioTasks, SaysHowStronglyTasksAreHeldAndWhatIsKept) {
  const TaskSettings settings = read(
      "tasks: {reaction: {opening: {force_Nm_per_rad: 700}, displacement_mm: 150}}\n"
      "constraints: {kept: always, self_collision: {activation_mm: 150, safety_mm: 120}}");
  EXPECT_EQ(settings.reaction.opening.force[0], 700.0);
  EXPECT_EQ(settings.reaction.displacement, 0.15);
  EXPECT_EQ(settings.constraints.kept, ConstraintsKept::always);
  EXPECT_EQ(settings.constraints.sigma_sc.safety, 0.12);
}

TEST(ScenarioTasks, RefuseLimitsThatLieTheWrongWayRound) {
  EXPECT_THROW(read("constraints: {condition_number: {activation: 16}}"), SetupError);
  EXPECT_THROW(read("constraints: {kept: sometimes}"), SetupError);
  EXPECT_THROW(read("tasks: {levels: {free_damping_per_s: 0}}"), SetupError);
}

}  // namespace
}  // namespace flinch
