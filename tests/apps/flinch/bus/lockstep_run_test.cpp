// A scenario against a served robot that waits for its controller: the run in simulation, bit for bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/flinch/bus/lockstep_rig.h"
#include "tests/apps/flinch/documented_keys.h"
#include "tests/support/busy_loops.h"

namespace flinch {
namespace {

using nlohmann::json;
using test::LockstepRig;
using test::RigOnTheBus;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  return LockstepRig::joined(std::move(arguments), more);
}

/// So long that no machine comes to its end before others have done what they shall.
const std::vector<std::string> for_long = {"--set", "duration_s=600"};

TEST(Lockstep, IsTheRunInSimulationBitForBitWhateverTheMachineDoes) {
  const LockstepRig lockstep("platform_collision");
  const test::BusyLoops beside(2);
  for (const char* const out : {"first", "second"}) EXPECT_EQ(lockstep.difference(out), "");
}

TEST(Lockstep, IsSoForEveryKindOfRobotWithItsFaultsAndOperators) {
  EXPECT_EQ(LockstepRig("brought_back").difference("live"), "");
  EXPECT_EQ(LockstepRig("hexapod_collision").difference("live"), "");
  EXPECT_EQ(LockstepRig("square", {"encoder2:drifting@0.5:-5"}).difference("live"), "");
  EXPECT_EQ(LockstepRig("square", {"link:delayed@0.6:0.005"}).difference("live"), "");
}

TEST(Lockstep, IsWhatTheRobotSaysUnlessSomebodyChooses) {
  const RigOnTheBus rig("platform_collision", {"--lockstep"});
  const test::Outcome live = test::flinch(with(rig.run_arguments(), {"--json"}));
  EXPECT_EQ(live.status, 0) << live.out << live.err;
  const json printed = json::parse(live.out);
  EXPECT_TRUE(printed.at("computer").is_null()) << "no clock took part";
  EXPECT_THAT(test::undocumented_keys(printed, "JSON"), IsEmpty());
  EXPECT_THAT(rig.server->output(), HasSubstr("in lockstep"));
  const test::Outcome told = test::flinch(rig.run_arguments());
  EXPECT_THAT(told.err, HasSubstr("in lockstep: robot and controller wait for one another"));
}

/// What the example says, and how it ends.
std::string swapped_plant(const std::vector<std::string>& arguments) {
  test::OtherProgram program(
      {.command = with({FLINCH_SWAP_EXAMPLE}, arguments), .environment = {}, .preloaded = "", .prepare = {}});
  const std::optional<int> status = program.wait(120s);
  return program.output() + (status == 0 ? "" : "it did not end well");
}

TEST(Lockstep, GivesAProgramOfOnesOwnTheSameRobotAsItsSimulation) {
  const RigOnTheBus rig("platform_collision", {"--lockstep"});
  const std::string simulated = swapped_plant({});
  EXPECT_THAT(simulated, HasSubstr("contact detected at 0."));
  EXPECT_EQ(swapped_plant({rig.domain}), simulated);
  EXPECT_THAT(swapped_plant({"loop"}), HasSubstr("DOMAIN: is 'loop'; it must be a whole number"));
}

TEST(Lockstep, TellsAtTheEndWhatItServed) {
  RigOnTheBus rig("platform_collision", {"--lockstep", "--json"});
  ASSERT_EQ(test::flinch(rig.run_arguments()).status, 0);
  rig.server->interrupt();
  EXPECT_EQ(rig.server->wait(20s), 0);
  const json served = json::parse(rig.server->output());
  EXPECT_THAT(test::undocumented_keys(served, "JSON"), IsEmpty());
  EXPECT_EQ(served["ticks"], 1200);
  EXPECT_EQ(served["runs"], 1);
  EXPECT_TRUE(served["lost_periods"].is_null());
}

TEST(Lockstep, IsRefusedWhereTheOtherEndGoesByTheClock) {
  const RigOnTheBus rig("platform_collision", {"--real-time"});
  const test::Outcome live = test::flinch(with(rig.run_arguments(), {"--lockstep"}));
  EXPECT_EQ(live.status, 2);
  EXPECT_THAT(live.err, HasSubstr("the robot goes by the clock, and this program in lockstep"));
  EXPECT_FALSE(std::filesystem::exists(rig.place / "live"));
}

TEST(Lockstep, RefusesAControllerThatGoesByTheClock) {
  RigOnTheBus rig("platform_collision", {"--lockstep"});
  for (const std::vector<std::string>& arguments :
       {with(rig.run_arguments(), {"--real-time"}), rig.on_bus({"link", rig.scenario_file})}) {
    const test::Outcome live = test::flinch(arguments);
    EXPECT_EQ(live.status, 2);
    EXPECT_THAT(live.err,
                HasSubstr("the robot goes in lockstep with its controller, and this program by the"));
  }
  EXPECT_FALSE(std::filesystem::exists(rig.place / "live"));
  EXPECT_TRUE(rig.server->writes("a program commands by the clock, and is not obeyed", 20s))
      << rig.server->output();
}

TEST(Lockstep, EndsWhereTheRobotIsGone) {
  RigOnTheBus rig("square", {"--lockstep"});
  test::OtherProgram run(
      test::flinch_program(with(with(rig.run_arguments(), for_long), {"--patience", "1"})));
  ASSERT_TRUE(run.writes("gate open", 20s)) << run.output();
  rig.server->kill();
  EXPECT_TRUE(run.writes("ended:     the robot has sent nothing for 1 s", 60s)) << run.output();
  EXPECT_EQ(run.wait(20s), 1) << run.output();
  EXPECT_THAT(run.output(), HasSubstr("verdict: bad\n  - the robot has sent nothing for 1 s\n"));
  const Recording recording = read_recording(rig.place / "live/run.h5");
  EXPECT_EQ(recording.attributes.at("run.ended"), "the robot has sent nothing for 1 s");
}

TEST(Lockstep, WaitsForTheNextControllerWhereOneIsGone) {
  RigOnTheBus rig("square", {"--lockstep", "--patience", "1"});
  {
    test::OtherProgram run(test::flinch_program(with(rig.run_arguments("killed"), for_long)));
    ASSERT_TRUE(run.writes("gate open", 20s)) << run.output();
    run.kill();
  }
  EXPECT_TRUE(rig.server->writes("the controller has sent nothing for 1 s", 60s)) << rig.server->output();
  EXPECT_EQ(test::flinch(rig.run_arguments("next")).status, 0);
}

TEST(Lockstep, TakesOneControllerOnly) {
  const RigOnTheBus rig("square", {"--lockstep", "--patience", "120"});
  test::OtherProgram first(test::flinch_program(with(rig.run_arguments("first"), for_long)));
  ASSERT_TRUE(first.writes("gate open", 20s)) << first.output();
  first.stop();
  const test::Outcome second = test::flinch(with(rig.run_arguments("second"), {"--patience", "0.5"}));
  EXPECT_EQ(second.status, 2) << second.out;
  EXPECT_THAT(second.err, HasSubstr("obeys another program"));
  first.resume();
  first.interrupt();
  EXPECT_EQ(first.wait(60s), 3) << "no longer obeyed: " << first.output();
}

TEST(Lockstep, StopsTheRobotOnCtrlC) {
  const RigOnTheBus rig("square", {"--lockstep"});
  test::OtherProgram run(test::flinch_program(with(rig.run_arguments(), for_long)));
  ASSERT_TRUE(run.writes("gate open", 20s)) << run.output();
  run.interrupt();
  EXPECT_EQ(run.wait(60s), 3) << run.output();
}

TEST(Lockstep, RefusesWhatDoesNotFit) {
  const RigOnTheBus rig("platform_collision", {"--lockstep"});
  const test::Outcome both = test::flinch(with(rig.run_arguments(), {"--lockstep", "--real-time"}));
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err, HasSubstr("--real-time"));
  const test::Outcome attended = test::flinch(with(rig.run_arguments(), {"--attended"}));
  EXPECT_EQ(attended.status, 2);
  EXPECT_THAT(attended.err, HasSubstr("--attended: a robot in lockstep goes faster or slower"));
  const test::Outcome simulated = test::flinch({"run", rig.scenario_file, "--lockstep"});
  EXPECT_EQ(simulated.status, 2);
  EXPECT_THAT(simulated.err, HasSubstr("only with --station dds"));
  const test::Outcome patient = test::flinch({"serve", rig.scenario_file, "--real-time", "--patience", "3"});
  EXPECT_EQ(patient.status, 2);
  EXPECT_THAT(patient.err, HasSubstr("--patience: "));
}

}  // namespace
}  // namespace flinch
