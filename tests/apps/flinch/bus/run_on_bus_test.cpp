// A scenario against the rig that another program serves: what it shows, and what stops it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "systems/framework/recording.h"
#include "systems/signals/gate_fault.h"
#include "systems/signals/reaction_state.h"
#include "tests/apps/flinch/bus/rig_on_the_bus.h"
#include "tests/apps/flinch/documented_keys.h"

namespace flinch {
namespace {

using nlohmann::json;
using test::RigOnTheBus;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int stopped_by_fault = 3;  // the program's exit status

/// The modes of a run, in order, each once.
std::vector<double> modes_of(const Recording& recording) {
  std::vector<double> modes = recording.column("reaction", "mode");
  modes.erase(std::unique(modes.begin(), modes.end()), modes.end());
  return modes;
}

TEST(RunOnBus, ShowsWhatTheSimulationShows) {
  const RigOnTheBus rig;
  const test::Outcome simulated =
      test::flinch({"run", rig.scenario_file, "--out", rig.place.at("simulated"), "--json"});
  std::vector<std::string> arguments = rig.run_arguments();
  arguments.push_back("--json");
  const test::Outcome live = rig.run(arguments);
  ASSERT_EQ(simulated.status, 0) << simulated.err;
  ASSERT_EQ(live.status, 0) << live.out << live.err;

  const json expected = json::parse(simulated.out), found = json::parse(live.out);
  EXPECT_EQ(found["verdict"], expected["verdict"]);
  EXPECT_EQ(found["witness"], "force_torque");
  ASSERT_EQ(found["contacts"].size(), 1U);
  const double in_process = expected["contacts"][0]["detection_ms"],
               on_bus = found["contacts"][0]["detection_ms"];
  std::cout << "detection [ms]: in process " << in_process << ", on the bus " << on_bus << std::endl;
  EXPECT_NEAR(on_bus, in_process, 2.0);
  EXPECT_NEAR(found["contacts"][0]["peak_force_N"], expected["contacts"][0]["peak_force_N"].get<double>(),
              10.0);
  EXPECT_EQ(modes_of(read_recording(rig.place / "live/run.h5")),
            modes_of(read_recording(rig.place / "simulated/run.h5")));
}

TEST(RunOnBus, IsReplayedBitForBitFromItsRecording) {
  const RigOnTheBus rig;
  ASSERT_EQ(rig.run(rig.run_arguments()).status, 0);
  const test::Outcome replayed = test::flinch(
      {"run", rig.place.at("live/run.h5"), "--station", "recorded", "--out", rig.place.at("replayed")});
  EXPECT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_THAT(replayed.err, HasSubstr("every signal is the same as before, bit for bit"));
}

TEST(RunOnBus, FindsTheRobotAgainWhereTheLastRunLeftIt) {
  const RigOnTheBus rig;
  for (int run = 0; run < 2; ++run) {
    const test::Outcome live = rig.run(rig.run_arguments());
    EXPECT_EQ(live.status, 0) << live.out << live.err;
  }
}

TEST(RunOnBus, SaysWhichChecksAreOffOnceTheGateOpens) {
  const RigOnTheBus rig("hexapod_collision");
  const test::Outcome live = rig.run(rig.run_arguments());
  EXPECT_THAT(live.out, HasSubstr("checks off         passive against active encoders (fault 13)"));
  const std::size_t told = live.err.find("check off: passive against active encoders (fault 13)");
  ASSERT_NE(told, std::string::npos) << live.err;
  EXPECT_LT(told, live.err.find("nominal; gate open")) << live.err;
}

TEST(RunOnBus, ComesToRestInOrderOnCtrlC) {
  const RigOnTheBus rig("square");
  test::OtherProgram run(test::flinch_program(rig.run_arguments()));
  ASSERT_TRUE(run.writes("gate open", 20s)) << run.output();
  std::this_thread::sleep_for(2s);  // in the middle of the square
  run.interrupt();
  EXPECT_EQ(run.wait(20s), stopped_by_fault) << run.output();

  const Recording recording = read_recording(rig.place / "live/run.h5");
  const std::vector<double> fault = recording.column("gate", "fault");
  const bool stopped_by_hand = fault.back() == static_cast<double>(GateFault::operator_stop);
  if (!stopped_by_hand && test::machine_stall() >= test::noticeable_stall) {
    GTEST_SKIP() << test::not_measured() << ": another fault came before Ctrl-C";
  }
  EXPECT_TRUE(stopped_by_hand);
  const auto speed = [&recording](std::size_t k) {
    return std::hypot(recording.column("motion", "velocity", 0)[k],
                      recording.column("motion", "velocity", 1)[k]);
  };
  const std::size_t stopped = static_cast<std::size_t>(
      std::find_if(fault.begin(), fault.end(), [](double f) { return f != 0.0; }) - fault.begin());
  std::cout << "Ctrl-C at " << speed(stopped) << " m/s, at rest after " << fault.size() - stopped << " ms"
            << std::endl;
  double fastest = 0.0;  // it may have been in a corner just then
  for (std::size_t k = stopped - std::min<std::size_t>(stopped, 500); k < stopped; ++k) {
    fastest = std::max(fastest, speed(k));
  }
  EXPECT_GT(fastest, 0.05) << "it was not moving";
  EXPECT_LT(speed(fault.size() - 1), 0.03);
  EXPECT_LT(fault.size() - stopped, 1000U);
}

TEST(RunOnBus, EndsWhereTheRobotIsGone) {
  RigOnTheBus rig("square");
  std::vector<std::string> arguments = rig.run_arguments();
  arguments.insert(arguments.end(), {"--patience", "1"});
  test::OtherProgram run(test::flinch_program(arguments));
  ASSERT_TRUE(run.writes("gate open", 20s)) << run.output();
  rig.server->kill();
  EXPECT_TRUE(run.writes("ended:     the robot has sent nothing for 1 s", 20s)) << run.output();
  EXPECT_EQ(run.wait(20s), stopped_by_fault) << run.output();
  const Recording recording = read_recording(rig.place / "live/run.h5");
  EXPECT_EQ(recording.attributes.at("run.ended"), "the robot has sent nothing for 1 s");
  EXPECT_LT(to_seconds(Time(recording.time_ns.back())), 3.4) << "the scenario takes 3.5 s";
}

TEST(RunOnBus, ServesUntilCtrlC) {
  RigOnTheBus rig;
  ASSERT_EQ(rig.run(rig.run_arguments()).status, 0);
  rig.server->interrupt();
  EXPECT_EQ(rig.server->wait(20s), 0);
  const json served = json::parse(rig.server->output());
  EXPECT_THAT(test::undocumented_keys(served, "JSON"), IsEmpty());
  EXPECT_GT(served["commands"], 1000);
}

TEST(RunOnBus, RefusesARobotThatItDoesNotKnow) {
  const RigOnTheBus rig;
  test::flinch(
      rig.on_bus({"link", rig.scenario_file, "--duration", "0.1", "--quiet"}));  // it has read its file
  rig.place.replace("robots/planar_3rrr.yaml", "platform:", "platform:  # another text");
  const test::Outcome live = test::flinch(rig.run_arguments());
  EXPECT_EQ(live.status, 2);
  EXPECT_THAT(live.err, HasSubstr("another robot description"));
  EXPECT_FALSE(std::filesystem::exists(rig.place / "live"));
}

TEST(RunOnBus, SaysWhereItLookedForARobotThatIsNotThere) {
  const test::Workplace place;
  const test::Outcome live =
      test::flinch({"run", place.at("scenarios/square.yaml"), "--station", "dds", "--domain",
                    std::to_string(test::free_domain()), "--patience", "0.3"});
  EXPECT_EQ(live.status, 2);
  EXPECT_THAT(live.err, HasSubstr("on lo: nobody sends joint readings there"));
}

TEST(RunOnBus, SaysThatTheKeysOfTheOtherEndAreOfAnotherAuthority) {
  const test::Workplace place;
  const std::string domain = std::to_string(test::free_domain());
  for (const char* const keys : {"robots_keys", "our_keys"}) {
    ASSERT_EQ(test::flinch({"keys", place.at(keys), "--quiet"}).status, 0);
  }
  test::OtherProgram server(
      test::flinch_program({"serve", place.at("scenarios/square.yaml"), "--domain", domain, "--security",
                            place.at("robots_keys"), "--duration", "120", "--real-time"}));
  ASSERT_TRUE(server.writes("drives: ", 20s)) << server.output();
  const test::Outcome live =
      test::flinch({"run", place.at("scenarios/square.yaml"), "--station", "dds", "--domain", domain,
                    "--security", place.at("our_keys"), "--patience", "2"});
  EXPECT_EQ(live.status, 2);
  EXPECT_THAT(live.err, HasSubstr("somebody is there whose certificate was refused"));
  EXPECT_LE(std::count(live.err.begin(), live.err.end(), '\n'), 6) << live.err;
}

TEST(RunOnBus, RefusesAnOperatorWhomNobodyWatches) {
  const test::Workplace place;
  const test::Outcome live = test::flinch({"run", place.at("scenarios/brought_back.yaml"), "--station", "dds",
                                           "--real-time", "--out", place.at("out")});
  EXPECT_EQ(live.status, 2);
  EXPECT_THAT(live.err,
              HasSubstr("brought_back.yaml: 'operator' resets and starts the robot though nobody sees"));
  EXPECT_FALSE(std::filesystem::exists(place / "out"));
}

TEST(RunOnBus, SetsKeysOfTheScenario) {
  const test::Workplace place;
  const test::Outcome live =
      test::flinch({"run", place.at("scenarios/square.yaml"), "--station", "dds", "--set", "duration_s=-1",
                    "--set", "operator=[{at_s: 0.5, press: reset}]", "--real-time"});
  EXPECT_EQ(live.status, 2);
  EXPECT_THAT(live.err, HasSubstr("--set duration_s=-1: duration_s: is -1; it must lie between"));
}

TEST(RunOnBus, RefusesOptionsThatMeanNothing) {
  const test::Workplace place;
  const test::Outcome seeded =
      test::flinch({"run", place.at("scenarios/square.yaml"), "--station", "dds", "--seed", "3"});
  EXPECT_EQ(seeded.status, 2);
  EXPECT_THAT(seeded.err, HasSubstr("--seed"));
  const test::Outcome controlled = test::flinch(
      {"run", place.at("scenarios/square.yaml"), "--control", place.at("scenarios/square.yaml")});
  EXPECT_EQ(controlled.status, 2);
  EXPECT_THAT(controlled.err, HasSubstr("--control"));
  const test::Outcome unknown = test::flinch({"run", place.at("scenarios/square.yaml"), "--station", "ddss"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--station: is 'ddss', which is no station"));
  const test::Outcome simulated =
      test::flinch({"run", place.at("scenarios/square.yaml"), "--security", place.at("keys")});
  EXPECT_EQ(simulated.status, 2);
  EXPECT_THAT(simulated.err, HasSubstr("only with --station dds"));
  for (const std::string duration : {"nan", "1e10", "-1", "soon"}) {
    const test::Outcome served =
        test::flinch({"serve", place.at("scenarios/square.yaml"), "--duration", duration});
    EXPECT_EQ(served.status, 2) << duration;
    EXPECT_THAT(served.err, HasSubstr("number of seconds")) << duration;
  }
}

TEST(RunOnBus, RefusesAReplayThatWouldReplaceItsRecording) {
  const test::Workplace place;
  ASSERT_EQ(
      test::flinch({"run", place.at("scenarios/stiffness.yaml"), "--out", place.at("run"), "--quiet"}).status,
      0);
  const std::string before = test::bytes_of(place / "run/run.h5");
  const test::Outcome replayed =
      test::flinch({"run", place.at("run/run.h5"), "--station", "recorded", "--out", place.at("run")});
  EXPECT_EQ(replayed.status, 2);
  EXPECT_THAT(replayed.err, HasSubstr("would replace it"));
  EXPECT_EQ(test::bytes_of(place / "run/run.h5"), before);
}

TEST(RunOnBus, TakesOneCommanderOnly) {
  const RigOnTheBus rig("square");
  test::OtherProgram first(test::flinch_program(rig.run_arguments("first")));
  ASSERT_TRUE(first.writes("gate open", 20s)) << first.output();
  std::vector<std::string> arguments = rig.run_arguments("second");
  arguments.insert(arguments.end(), {"--patience", "1"});
  const test::Outcome second = test::flinch(arguments);
  EXPECT_EQ(second.status, 2) << second.out << first.output();
  EXPECT_THAT(second.err, HasSubstr("obeys another program"));
  const std::optional<int> status = first.wait(20s);
  if (status == stopped_by_fault && test::machine_stall() >= test::noticeable_stall) {
    GTEST_SKIP() << test::not_measured() << ": whether the first goes on undisturbed";
  }
  EXPECT_EQ(status, 0) << first.output();
}

TEST(Link, IsMeasuredWithoutMovingAnything) {
  const RigOnTheBus rig;
  const test::Outcome link = test::flinch(
      rig.on_bus({"link", rig.place.at("robots/planar_3rrr.yaml"), "--duration", "1", "--json"}));
  const json report = json::parse(link.out);
  std::cout << report.dump() << std::endl;
  EXPECT_THAT(test::undocumented_keys(report, "JSON"), IsEmpty());
  EXPECT_EQ(report["ticks"].get<int>() + report["lost_periods"].get<int>(), 1000);
  EXPECT_GT(report["received"], 900);
  EXPECT_GT(report["round_trip"]["count"], 800);
  EXPECT_GT(report["round_trip"]["p50_us"], 0.0);
  EXPECT_LE(report["round_trip"]["p50_us"], report["round_trip"]["max_us"]);
  EXPECT_EQ(report["platform"].size(), 3U);
  EXPECT_LT(report["closure_error_m"], 0.005);
  EXPECT_EQ(report["good"].get<bool>(), report["objections"].empty());
  EXPECT_EQ(link.status, report["good"].get<bool>() ? 0 : 1);
}

}  // namespace
}  // namespace flinch
