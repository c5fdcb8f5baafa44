#include "experiments/simulated/exported_truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/recorded/recorded_signals.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/simulated_station.h"
#include "systems/framework/constant.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::UnorderedElementsAre;

std::vector<std::string> exported(const std::string& scenario_file,
                                  const std::vector<std::string>& set = {}) {
  const SimulatedScenario scenario = read_simulated_scenario(test::shipped(scenario_file), set);
  DiagramBuilder builder("bench", scenario.control_period);
  const SimulatedStation station = add_simulated_station(builder, scenario.station);
  builder.connect(builder.add<Constant<TorqueCommand>>("torque", TorqueCommand()).value,
                  station.torque_command);
  builder.connect(builder.add<Constant<BrakeCommand>>("brake", BrakeCommand()).value, station.brake);
  export_truth(builder, scenario, station);
  return recorded_paths(*builder.build());
}

TEST(ExportedTruth, IsOfTheRobotItsContactsAndItsLimits) {
  EXPECT_THAT(exported("scenarios/platform_collision.yaml"),
              UnorderedElementsAre("truth", "contact", "true_measures"));
}

TEST(ExportedTruth, IsOfObstaclesWhereTheyMove) {
  EXPECT_THAT(exported("papers/second_link_push.yaml"),
              UnorderedElementsAre("truth", "contact", "true_measures", "obstacles"));
}

}  // namespace
}  // namespace flinch
