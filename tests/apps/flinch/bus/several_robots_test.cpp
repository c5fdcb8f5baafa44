// Several served robots on one bus, and who commands one of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/flinch/program.h"
#include "tests/support/flinch_program.h"
#include "tests/support/free_domain.h"
#include "tests/support/machine_monitor.h"
#include "tests/support/other_program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

constexpr int stopped_by_fault = 3;  // the program's exit status

/// A bus, with a place for results.
struct Laboratory {
  explicit Laboratory(const std::string& scenario = "platform_collision")
      : scenario_file(place.at("scenarios/" + scenario + ".yaml")) {}

  std::vector<std::string> on_bus(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--domain", domain});
    return arguments;
  }
  std::vector<std::string> run_arguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments =
        on_bus({"run", scenario_file, "--station", "dds", "--out", place.at("live")});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  test::OtherProgram::Start serving(const std::string& name) const {
    return test::flinch_program(
        on_bus({"serve", scenario_file, "--robot", name, "--duration", "120", "--real-time"}));
  }

  test::Workplace place;
  std::string domain = std::to_string(test::free_domain());
  std::string scenario_file;
};

/// A served robot, once it is on the bus.
struct ServedRobot {
  ServedRobot(const Laboratory& laboratory, const std::string& name) : program(laboratory.serving(name)) {
    EXPECT_TRUE(program.writes("as robot " + name + " (", 20s)) << program.output();
    EXPECT_TRUE(program.writes("drives: ", 20s)) << program.output();
  }

  /// What it has said by its end.
  std::string end() {
    program.interrupt();
    EXPECT_EQ(program.wait(20s), 0) << program.output();
    return program.output();
  }

  test::OtherProgram program;
};

TEST(SeveralServedRobots, AreNotCommandedWhereNoneIsChosen) {
  const Laboratory laboratory;
  ServedRobot left(laboratory, "left"), right(laboratory, "right");
  EXPECT_TRUE(right.program.writes("warning: 2 robots are on this bus", 20s)) << right.program.output();
  const test::Outcome run = test::flinch(laboratory.run_arguments());
  EXPECT_EQ(run.status, 2) << run.out << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("there are 2 robots on the bus"), HasSubstr("left ("),
                             HasSubstr("right ("), HasSubstr("choose one with --robot")));
  EXPECT_FALSE(std::filesystem::exists(laboratory.place / "live"));

  const test::Outcome link = test::flinch(laboratory.on_bus({"link", laboratory.scenario_file, "--json"}));
  EXPECT_EQ(link.status, 1) << link.err;
  const json report = json::parse(link.out);
  EXPECT_EQ(report["good"], false);
  EXPECT_TRUE(report["robot"].is_null());
  EXPECT_EQ(report["robots"].size(), 2U) << link.out;
  EXPECT_THAT(left.end(), HasSubstr("; 0 commands,"));
  EXPECT_THAT(right.end(), HasSubstr("; 0 commands,"));
}

TEST(SeveralServedRobots, LetTheChosenOneMoveAndNoOther) {
  const Laboratory laboratory;
  ServedRobot left(laboratory, "left"), right(laboratory, "right");
  const test::Outcome run = test::flinch(laboratory.run_arguments({"--robot", "right"}));
  EXPECT_THAT(run.err, AllOf(HasSubstr("was commanded; on the bus were"), HasSubstr("left (")));
  const std::string of_left = left.end(), of_right = right.end();
  EXPECT_THAT(of_left, HasSubstr("; 0 commands,"));
  EXPECT_EQ(of_left.find("brakes open"), std::string::npos) << of_left;
  EXPECT_THAT(of_right, HasSubstr("brakes open"));
  if (run.status == stopped_by_fault && test::machine_stall() >= test::noticeable_stall) {
    GTEST_SKIP() << test::not_measured() << ": whether the run goes well";
  }
  EXPECT_EQ(run.status, 0) << run.out << run.err;
}

TEST(SeveralServedRobots, SayWhichThereAreWhereTheChosenOneIsNot) {
  const Laboratory laboratory;
  ServedRobot left(laboratory, "left");
  const test::Outcome run = test::flinch(laboratory.run_arguments({"--robot", "right", "--patience", "1"}));
  EXPECT_EQ(run.status, 2) << run.out << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("the robot that --robot chooses"), HasSubstr("left (")));
  EXPECT_THAT(left.end(), HasSubstr("; 0 commands,"));
}

TEST(SeveralServedRobots, LeaveARunAloneThatHasBegun) {
  const Laboratory laboratory("square");
  ServedRobot first(laboratory, "first");
  test::OtherProgram run(test::flinch_program(laboratory.run_arguments()));
  ASSERT_TRUE(run.writes("gate open", 20s)) << run.output();
  ServedRobot second(laboratory, "second");
  const std::optional<int> status = run.wait(60s);
  EXPECT_THAT(run.output(), AllOf(HasSubstr("was commanded; on the bus were"), HasSubstr("second (")));
  const std::string of_second = second.end();
  EXPECT_THAT(of_second, HasSubstr("; 0 commands,"));
  EXPECT_EQ(of_second.find("brakes open"), std::string::npos) << of_second;
  if (status == stopped_by_fault && test::machine_stall() >= test::noticeable_stall) {
    GTEST_SKIP() << test::not_measured() << ": whether the run goes on undisturbed";
  }
  EXPECT_EQ(status, 0) << run.output();
}

TEST(ServedRobot, RefusesANameThatIsNone) {
  const Laboratory laboratory;
  const test::Outcome serve =
      test::flinch(laboratory.on_bus({"serve", laboratory.scenario_file, "--robot", "left arm"}));
  EXPECT_EQ(serve.status, 2);
  EXPECT_THAT(serve.err, HasSubstr("the name 'left arm' of the robot has other letters"));
}

}  // namespace
}  // namespace flinch
