// What a run on the bus says before it begins; that it runs, tests/apps/flinch/bus shows with whole programs.
#include "experiments/bus/live_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <thread>

#include "diagrams/external_station.h"
#include "drivers/dds_bus.h"
#include "drivers/dds_server.h"
#include "drivers/wire_header.h"
#include "experiments/scenario/scenario.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/realtime_runner.h"
#include "tests/support/free_domain.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Why a run of a shipped scenario did not begin.
std::string why_not(const LiveRunSettings& settings) {
  const Scenario scenario = read_scenario(test::shipped("scenarios/platform_collision.yaml"));
  const DdsBus bus({.domain = test::free_domain()});
  try {
    run_live_experiment(scenario, bus, "never_made.h5", settings);
  } catch (const SetupError& error) {
    EXPECT_FALSE(std::filesystem::exists("never_made.h5.part"));
    return error.what();
  }
  return "it ran";
}

TEST(LiveRun, SaysThatNobodyIsThere) {
  EXPECT_THAT(why_not({.patience = 100ms}), HasSubstr("nobody sends joint readings there"));
}

TEST(LiveRun, DoesNotWaitForARobotWhenSomebodyInterrupts) {
  EXPECT_THAT(why_not({.patience = 10min, .interrupts = [] { return 1; }}),
              HasSubstr("interrupted; nothing has moved"));
}

TEST(LiveRun, TellsWithItsFileWhatIsWrongWithTheScenario) {
  Scenario scenario = read_scenario(test::shipped("scenarios/square.yaml"));
  scenario.control.contact_detector.reaction.force = -1.0;
  const DdsBus bus({.domain = test::free_domain()});
  try {
    const LiveRun run(scenario, bus, {});
    ADD_FAILURE() << "it was taken";
  } catch (const SetupError& error) {
    EXPECT_THAT(error.what(), HasSubstr("square.yaml: "));
  }
}

/// A robot on the bus whose readings are none, in a thread of its own until the end of the test.
class RobotOnTheBus {
 public:
  RobotOnTheBus(const Scenario& scenario, const DdsBus& bus, Time period)
      : diagram_(build(scenario, period)),
        server_(bus, *diagram_, station_, {.robot = robot_hash(scenario.robot_text)}),
        thread_([this] {
          ClockTicks ticks;
          Context context = diagram_->make_context();
          RealtimeRunner(*diagram_, ticks, server_).run(context, Time::max(), [this] {
            return over_.load();
          });
        }) {}
  ~RobotOnTheBus() {
    over_ = true;
    thread_.join();
  }

 private:
  std::unique_ptr<Diagram> build(const Scenario& scenario, Time period) {
    DiagramBuilder builder("robot", period);
    station_ = add_external_station(builder, scenario.robot.robot);
    station_.torque_command = builder.export_input("torque_command", station_.torque_command);
    station_.brake = builder.export_input("brake", station_.brake);
    return builder.build();
  }

  Station station_;
  std::unique_ptr<Diagram> diagram_;
  DdsServer server_;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

TEST(LiveRun, DoesNotBeginWhereTheRobotRunsAtAnotherRate) {
  const std::filesystem::path file = test::shipped("scenarios/platform_collision.yaml");
  const Scenario scenario = read_scenario(file);
  const DdsBus bus({.domain = test::free_domain()});
  const RobotOnTheBus robot(scenario, bus, 4ms);
  const auto problems =
      test::problems_of([&] { run_live_experiment(scenario, bus, "never_made.h5", {.patience = 20s}); });
  EXPECT_THAT(problems, ElementsAre(AllOf(HasSubstr("the robot runs with a control period of 4000 us"),
                                          HasSubstr("this program with 1000 us"))));
  EXPECT_FALSE(std::filesystem::exists("never_made.h5.part"));
}

}  // namespace
}  // namespace flinch
