#include "experiments/scenario/scenario_tasks.h"

#include <gmock/gmock.h>

#include <memory>

#include "diagrams/task_settings.h"
#include "systems/config/config_reader.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "tests/support/planar_rig.h"

namespace flinch {
namespace {

TaskSettings read(const std::string& text,
                  const std::shared_ptr<const ParallelRobot>& robot = test::planar_rig()) {
  ConfigReader reader = ConfigReader::parse(text, "some.yaml");
  TaskSettings settings;
  read_tasks(reader, *robot, settings);
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

TEST(ScenarioTasks, HaveTheUnitsOfDrivesThatSlide) {
  const auto hexapod = std::make_shared<Hexapod>(hexapod_robot());
  const TaskSettings settings = read(
      "tasks: {levels: {velocity_gain_Ns_per_m: 700, largest_acceleration_m_per_s2: 20, "
      "largest_torque_N: 400, largest_torque_rate_N_per_s: 9000}}",
      hexapod);
  EXPECT_EQ(settings.levels.velocity_gain, 700.0);
  EXPECT_EQ(settings.levels.largest_acceleration, 20.0);
  EXPECT_EQ(settings.levels.largest_torque, 400.0);
  EXPECT_EQ(settings.levels.largest_torque_rate, 9000.0);
  EXPECT_THROW(read("tasks: {levels: {largest_torque_Nm: 400}}", hexapod), SetupError);
  EXPECT_EQ(read("tasks: {levels: {largest_torque_Nm: 40}}").levels.largest_torque, 40.0);
}

TEST(ScenarioTasks, RefuseLimitsThatLieTheWrongWayRound) {
  EXPECT_THROW(read("constraints: {condition_number: {activation: 16}}"), SetupError);
  EXPECT_THROW(read("constraints: {kept: sometimes}"), SetupError);
  EXPECT_THROW(read("tasks: {levels: {free_damping_per_s: 0}}"), SetupError);
}

}  // namespace
}  // namespace flinch
