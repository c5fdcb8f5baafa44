// Others on the bus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/wire_header.h"
#include "tests/fault/link/link_course.h"
#include "tests/fault/link/link_trial.h"
#include "tests/fault/link/stranger.h"
#include "tests/fault/link/trials.h"

namespace flinch::test {
namespace {

using testing::HasSubstr;

constexpr const char* robot_file = "robots/planar_3rrr.yaml";

bool is_open(const BusLog& log) { return log.status[log.status.count - 1].braked == 0; }

/// What was sent to the robot until now by whom it obeys. A commander that failed before it was heard is left
/// out: the robot does not know that one.
struct Recorded {
  explicit Recorded(const BusLog& log) {
    const std::uint32_t session = present_commander(log);
    for (std::uint32_t i = 0; i < log.commands.count; ++i)
      if (log.commands[i].header.session == session) commands.push_back(log.commands[i]);
    for (std::uint32_t i = 0; i < log.requests.count; ++i)
      if (log.requests[i].header.session == session) requests.push_back(log.requests[i]);
  }
  std::vector<flinch_TorqueSample> commands;
  std::vector<flinch_DriveRequest> requests;
};

/// The robot obeys nobody, and its brakes stay closed.
void expect_nothing_moves(const BusLog& log, const LogEnd& begin) {
  const Course stood = course(log, begin, 0);
  EXPECT_EQ(stood.silent, stood.ticks);
  EXPECT_EQ(stood.braked, stood.ticks);
}

/// A robot that stands there alone hears commands for a second, and obeys none. `other_id`: bits
/// in which the identity that they name is another than its own.
void expect_refusal(LinkTrial& trial, std::uint32_t robot, std::uint16_t version,
                    std::uint64_t other_id = 0) {
  trial.start_robot();
  EXPECT_TRUE(wait_until(5s, [&] { return trial.at_robot().status.count > 100; }));
  const std::uint64_t named = present_robot(trial.at_robot()) ^ other_id;
  const OtherProgram other = stranger(trial.domain(), robot, version, named);
  const LogEnd begin(trial.at_robot());
  EXPECT_TRUE(wait_until(5s, [&] { return course(trial.at_robot(), begin, 0).refused > 300; }));
  expect_nothing_moves(trial.at_robot(), begin);
}

void expect_message(OtherProgram& program, const std::string& message) {
  EXPECT_EQ(program.wait(8s), 2);
  EXPECT_THAT(program.output(), HasSubstr(message));
}

}  // namespace

TrialOutcome second_robot() {
  LinkTrial trial;
  expect_refusal(trial, shipped_robot(robot_file), protocol_version, 1);
  const LogEnd begin(trial.at_robot());
  const OtherProgram robot = strange_robot(trial.domain(), shipped_robot(robot_file), protocol_version);
  OtherProgram program(flinch_program({"run", shipped_file("scenarios/square.yaml"), "--station", "dds",
                                       "--domain", std::to_string(trial.domain())}));
  expect_message(program, "there are 2 robots on the bus");
  expect_nothing_moves(trial.at_robot(), begin);
  return {};
}

TrialOutcome second_commander() {
  expect_undisturbed([] {
    LinkTrial trial;
    trial.get_moving();
    const BusLog& log = trial.at_robot();
    const std::uint32_t session = present_commander(log);
    const LogEnd begin(log);
    const OtherProgram other =
        stranger(trial.domain(), shipped_robot(robot_file), protocol_version, present_robot(log));
    const auto program = trial.other_commander({"--patience", "1"});
    EXPECT_TRUE(wait_until(3s, [&] { return course(log, begin, session).refused > 500; }));
    const Course went = course(log, begin, session);
    expect_message(*program, "the robot obeys another program");
    return went;
  });
  return {};
}

TrialOutcome replay_commands() {
  expect_undisturbed([] {
    LinkTrial trial;
    trial.get_moving();
    const BusLog& log = trial.at_robot();
    const Recorded recorded(log);
    const std::uint32_t last = recorded.commands.back().header.number;
    EXPECT_TRUE(wait_until(1s, [&] { return log.status[log.status.count - 1].command_number > last; }));
    const auto lose_commander = [&] {
      trial.commander().kill();
      EXPECT_TRUE(wait_until(1s, [&] { return present_commander(log) == 0 && !is_open(log); }));
    };
    const auto expect_refused_while_nobody_commands = [&] {
      const LogEnd begin(log);
      const OtherProgram replay = replayer(trial.domain(), recorded.requests, recorded.commands);
      const auto all = static_cast<std::uint32_t>(recorded.commands.size() * 9 / 10);
      EXPECT_TRUE(wait_until(10s, [&] { return course(log, begin, 0).refused > all; }));
      expect_nothing_moves(log, begin);
    };
    lose_commander();
    expect_refused_while_nobody_commands();

    trial.get_moving_again();
    const LogEnd begin(log);
    const std::uint32_t session = present_commander(log);
    Course went;
    {
      const OtherProgram replay = replayer(trial.domain(), recorded.requests, recorded.commands);
      EXPECT_TRUE(wait_until(3s, [&] { return course(log, begin, session).refused > 200; }));
      went = course(log, begin, session);
    }
    lose_commander();
    expect_refused_while_nobody_commands();
    return went;
  });
  return {};
}

TrialOutcome wrong_version() {
  LinkTrial trial;
  expect_refusal(trial, shipped_robot(robot_file), protocol_version + 1);
  trial.robot().kill();
  const OtherProgram robot = strange_robot(trial.domain(), shipped_robot(robot_file), protocol_version + 1);
  OtherProgram program(flinch_program({"run", shipped_file("scenarios/square.yaml"), "--station", "dds",
                                       "--domain", std::to_string(trial.domain())}));
  expect_message(program, "another version of the protocol");
  return {};
}

TrialOutcome other_robot_file() {
  LinkTrial trial;
  expect_refusal(trial, shipped_robot("robots/planar_3rrr_nominal.yaml"), protocol_version);
  OtherProgram program(flinch_program(
      {"link", shipped_file("robots/planar_3rrr_nominal.yaml"), "--domain", std::to_string(trial.domain())}));
  expect_message(program, "another robot description");
  return {};
}

}  // namespace flinch::test
