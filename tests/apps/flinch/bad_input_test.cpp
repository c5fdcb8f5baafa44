// Whatever is wrong with what the program is given: one clear sentence on stderr, exit status 2, and no file
// written or overwritten.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "systems/framework/recording.h"
#include "tests/apps/flinch/bad_input.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::flinch;
using test::Outcome;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

using test::BadInput;

constexpr const char* robot = "robots/planar_3rrr.yaml";

// ---------------------------------------------------------------- scenario files

TEST_F(BadInput, MotionThatTheLegsDoNotReach) {
  place.replace(collision, "pose: {x_mm: -40", "pose: {x_mm: -640");
  const std::string said = complaint_of_run();
  EXPECT_THAT(said, StartsWith(at_line_of(collision, "motion:") + "motion: "));
  EXPECT_THAT(said, HasSubstr("the legs do not reach the pose (-0.6"));
}

TEST_F(BadInput, MotionThatTakesMorePlanningThanAnyRobotNeeds) {
  const std::string head = "robot: ../robots/planar_3rrr.yaml\nduration_s: 3600\nmotion: ";
  place.write("scenarios/tiny.yaml",
              head + "{kind: random, distance_mm: 0.001, rotation_deg: 0, duration_s: 3600}\n");
  EXPECT_THAT(
      complaint({"check", place.at("scenarios/tiny.yaml")}),
      MatchesRegex("error: .*tiny.yaml:3: motion: the robot cannot move like this: 50000 random poses "
                   "within 1e-06 m .*; raise distance, rotation or pause, or lower duration\n"));
  place.write("scenarios/slow.yaml", head + "{kind: square, laps: 1000, limits: {velocity_m_per_s: 1e-9}}\n");
  EXPECT_THAT(
      complaint({"check", place.at("scenarios/slow.yaml")}),
      MatchesRegex("error: .*slow.yaml:3: motion: the robot cannot move like this: platform path: takes "
                   ".* s, and may take 10000 s; raise the limits, or .*\n"));
}

TEST_F(BadInput, MoreCalibrationsThanAnybodyHas) {
  std::string list;
  for (int i = 0; i < 101; ++i) list += i == 0 ? "*a" : ", *a";
  place.write("scenarios/many.yaml",
              "title: &a {file: none.yaml}\nrobot: ../robots/planar_3rrr.yaml\n"
              "duration_s: 1\ncalibrations: [" +
                  list + "]\n");
  const Outcome outcome = flinch({"check", place.at("scenarios/many.yaml")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("many.yaml:4: calibrations: is a list of 101; it may have 100 entries"));
}

TEST_F(BadInput, KindsThatNobodyKnowsAloneAreTold) {
  place.replace(collision, "kind: passage", "kind: pasage");
  EXPECT_EQ(complaint_of_run(),
            at_line_of(collision, "pasage") + "motion.kind: is 'pasage'; did you mean 'passage'?\n");
  place.replace(collision, "kind: pasage", "kind: passage");
  place.replace(collision, "pylon: {", "obstacles: [{shape: cone, height_m: 1, ");
  place.replace(collision, "stiffness_N_per_m: 6000}", "stiffness_N_per_m: 6000}]");
  const std::string place_of_obstacle = at_line_of(collision, "obstacles") + "obstacles[0].";
  EXPECT_EQ(complaint_of_run(),
            place_of_obstacle + "shape: is 'cone'; known are: sphere, capsule, box, hull\n");
  place.replace(collision, "shape: cone, height_m: 1", "kind: mving, path: []");
  EXPECT_EQ(complaint_of_run(),
            place_of_obstacle + "kind: is 'mving'; known are: fixed, compliant, path, hand\n");
}

TEST_F(BadInput, KeyWithTheUnitOfAnotherQuantity) {
  place.replace(collision, "speed_m_per_s", "speed_m");
  EXPECT_EQ(complaint_of_run(), at_line_of(collision, "speed_m") +
                                    "motion.speed_m: has the wrong unit, m; write speed_m_per_s or "
                                    "speed_mm_per_s\n");
}

TEST_F(BadInput, KeyThatNobodyKnows) {
  place.replace(collision, "reaction_force_N", "reacton_force_N");
  EXPECT_EQ(complaint_of_run(), at_line_of(collision, "reacton_force_N") +
                                    "control.contact_detector.reacton_force_N: is not a known key; did you "
                                    "mean 'reaction_force_N'?\n");
}

TEST_F(BadInput, KeyThatIsGivenTwice) {
  place.replace(collision, "seed: 1\n", "seed: 1\nseed: 2\n");
  EXPECT_EQ(complaint_of_run(), at_line_of(collision, "seed: 2") + "seed: is given already on line " +
                                    std::to_string(place.line_of(collision, "seed: 1")) +
                                    "; keep one of them\n");
}

TEST_F(BadInput, NumberThatIsNone) {
  place.replace(collision, "cruise_mm: 80", "cruise_mm: .nan");
  EXPECT_EQ(complaint_of_run(),
            at_line_of(collision, ".nan") + "motion.cruise_mm: is .nan; it must be a finite number\n");
}

TEST_F(BadInput, ExpectationAboutAnUnknownBody) {
  place.replace(collision, "contact: platform", "contact: plattform");
  EXPECT_EQ(complaint_of_run(), at_line_of(collision, "plattform") +
                                    "expect.contact: is 'plattform', which is no body of this robot; did you "
                                    "mean 'platform'?\n");
}

TEST_F(BadInput, SettingsThatDoNotFitTogether) {
  place.replace(collision, "reaction_force_N: 10", "reaction_force_N: 100");
  EXPECT_THAT(
      complaint_of_run(),
      MatchesRegex("error: .*platform_collision.yaml:[0-9]+: control.contact_detector.hard_force: is .* N; "
                   "it must be at least reaction_force, which is 100 N\n"));
}

TEST_F(BadInput, ScenarioThatIsNotThere) {
  EXPECT_EQ(complaint_of_run("scenarios/platform_colision.yaml"),
            "error: " + place.at("scenarios/platform_colision.yaml") +
                ": no such file; did you mean 'platform_collision.yaml'?\n");
}

TEST_F(BadInput, EveryProblemIsToldAtOnce) {
  place.replace(collision, "speed_m_per_s: 0.95", "speed_m_per_s: -1");
  place.replace(collision, "seed: 1", "seed: one");
  place.replace(robot, "mass_kg: 0.642", "mass_kg: 0");
  const Outcome outcome = flinch({"run", place.at(collision), "--out", place.at("out")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr(at_line_of(collision, "speed_m_per_s") + "motion.speed_m_per_s: is -1"));
  EXPECT_THAT(outcome.err, HasSubstr(at_line_of(collision, "seed: one") + "seed: is 'one'"));
  EXPECT_THAT(outcome.err, HasSubstr("planar_3rrr.yaml:"));
  EXPECT_THAT(outcome.err, HasSubstr("platform.mass_kg: is 0 kg; it must be positive"));
}

// ---------------------------------------------------------------- robot files

TEST_F(BadInput, RobotThatIsNotThere) {
  place.replace(collision, "planar_3rrr.yaml", "planar_3rrrr.yaml");
  const std::string said = complaint_of_run();
  EXPECT_THAT(said, StartsWith(at_line_of(collision, "planar_3rrrr.yaml") +
                               "robot: is '../robots/planar_3rrrr.yaml'"));
  EXPECT_THAT(said, HasSubstr("no such file; did you mean 'planar_3rrr.yaml'?"));
}

TEST_F(BadInput, MassThatIsNegative) {
  place.replace(robot, "mass_kg: 0.642", "mass_kg: -0.642");
  EXPECT_EQ(complaint_of_run(),
            at_line_of(robot, "mass_kg: -0.642") + "platform.mass_kg: is -0.642 kg; it must be positive\n");
}

TEST_F(BadInput, InertiaThatIsNotPositiveDefinite) {
  const std::string inertia = "base_parameters: {p1_kg_m2: 0.6, p2_kg_m2: 0.01, p3_kg_m2: 0.1356582}";
  place.replace(robot, "base_parameters: *leg_inertia", inertia);
  const std::string said = complaint_of_run();
  EXPECT_THAT(said, StartsWith(at_line_of(robot, inertia) + "legs[1].base_parameters: "));
  EXPECT_THAT(said,
              HasSubstr("(p1 - p2) p2 = 0.0059 and p3^2 = 0.0184031 kg^2 m^4; the first must be greater"));
}

TEST_F(BadInput, RobotFileIsNamedAsTheScenarioFindsIt) {
  place.replace(robot, "link_radius_m: 0.03", "link_radius_m: .inf");
  EXPECT_THAT(complaint({"check", place.at(robot)}),
              StartsWith(at_line_of(robot, ".inf") + "link_radius_m: is .inf"));
}

// ---------------------------------------------------------------- recordings

TEST_F(BadInput, RecordingWithoutItsEnd) {
  ASSERT_EQ(flinch({"run", place.at(collision), "--out", place.at("whole")}).status, 0);
  const std::string whole = test::bytes_of(place / "whole/run.h5");
  place.write("out/run.h5", whole.substr(0, whole.size() / 2));
  for (const std::string verb : {"report", "check"}) {
    const std::string said = complaint({verb, place.at("out/run.h5")});
    EXPECT_THAT(said, StartsWith("error: " + place.at("out/run.h5") + ": this is no whole flinch recording"));
    EXPECT_THAT(said, HasSubstr("its end is missing"));
  }
}

TEST_F(BadInput, RecordingThatIsNoRecording) {
  place.write("notes.txt", "not recorded by anything\n");
  EXPECT_THAT(complaint({"report", place.at("notes.txt"), "--out", place.at("out/report.html")}),
              StartsWith("error: " + place.at("notes.txt") + ": this is no whole flinch recording"));
  EXPECT_EQ(complaint({"report", place.at("out/none.h5")}),
            "error: " + place.at("out/none.h5") + ": there is no such file\n");
}

TEST_F(BadInput, ScenarioInThePlaceOfARecording) {
  const std::string what = "is a scenario, not a recording; 'flinch run' runs it";
  EXPECT_THAT(complaint({"report", place.at(collision)}), HasSubstr(what));
  EXPECT_THAT(complaint({"run", "--station", "recorded", place.at(collision)}), HasSubstr(what));
  EXPECT_THAT(complaint({"calibrate", "thresholds", place.at(collision), "--out", place.at("out/t.yaml")}),
              HasSubstr(what));
}

TEST_F(BadInput, PipeThatNobodyWritesTo) {
  const test::Workplace pipes;
  for (const char* const name : {"pipe.yaml", "pipe.h5", "pipe.onnx", "gone.h5.part"})
    ASSERT_EQ(::mkfifo(pipes.at(name).c_str(), 0600), 0);
  const std::vector<std::vector<std::string>> calls = {
      {"check", pipes.at("pipe.yaml")},
      {"check", pipes.at("pipe.h5")},
      {"report", pipes.at("pipe.h5")},
      {"report", pipes.at("gone.h5")},
      {"run", pipes.at("pipe.yaml")},
      {"run", pipes.at("pipe.h5"), "--station", "recorded"},
      {"run", place.at(collision), "--classifier", pipes.at("pipe.onnx")},
      {"evaluate", pipes.at("pipe.onnx"), pipes.at("pipe.h5")},
      {"import", pipes.at("pipe.yaml"), "--out", place.at("out/imported.h5")},
      {"convert", pipes.at("pipe.yaml"), "--platform", "p", "--out", place.at("out/robot.yaml")}};
  for (const std::vector<std::string>& call : calls)
    EXPECT_THAT(complaint(call), HasSubstr("is no regular file; it must be one"))
        << call[0] << " " << call[1];
}

TEST_F(BadInput, RecordingOfAnotherProgram) {
  Recording recording;
  recording.period = 1ms;
  recording.time_ns = {0};
  write_recording(recording, place / "out/run.h5");
  for (const std::string verb : {"report", "check"}) {
    EXPECT_EQ(complaint({verb, place.at("out/run.h5")}),
              "error: " + place.at("out/run.h5") +
                  ": the recording has no attribute 'scenario.file'; it was not made by 'flinch run'\n");
  }
}

TEST_F(BadInput, ControlOfAnotherRobotThanTheRecorded) {
  ASSERT_EQ(flinch({"run", place.at(collision), "--out", place.at("whole")}).status, 0);
  for (const std::string other :
       {"apps/scenarios/hexapod_collision.yaml", "apps/scenarios/five_bar_collision.yaml"}) {
    EXPECT_THAT(complaint({"run", place.at("whole/run.h5"), "--station", "recorded", "--control", other,
                           "--out", place.at("out")}),
                AllOf(StartsWith("error: " + other + ": is for the robot '"),
                      HasSubstr(place.at("whole/run.h5") + " was recorded of '")));
  }
}

TEST_F(BadInput, RecordingThatLacksASignalOrItsSeed) {
  ASSERT_EQ(flinch({"run", place.at(collision), "--out", place.at("out")}).status, 0);
  const Recording whole = read_recording(place / "out/run.h5");
  Recording spoilt = whole;
  std::erase_if(spoilt.signals, [](const Signal& signal) { return signal.path == "wrench"; });
  write_recording(spoilt, place / "out/run.h5");
  const std::string said = complaint({"check", place.at("out/run.h5")});
  EXPECT_THAT(said, StartsWith("error: " + place.at("out/run.h5") + ": "));
  EXPECT_THAT(said, HasSubstr("'wrench'"));

  spoilt = whole;
  spoilt.attributes["seed"] = "one";
  write_recording(spoilt, place / "out/run.h5");
  EXPECT_EQ(complaint({"report", place.at("out/run.h5")}),
            "error: " + place.at("out/run.h5") +
                ": the attribute 'seed' is 'one'; it must be a whole number between 0 and 2^64 - 1\n");
}

// ---------------------------------------------------------------- the command line

TEST_F(BadInput, FolderThatCannotBeMade) {
  for (const std::string folder : {"out/run.h5", "out/run.h5/below"}) {
    EXPECT_EQ(complaint({"run", place.at(collision), "--out", place.at(folder)}),
              "error: " + place.at(folder) + ": the folder cannot be made: Not a directory\n");
  }
}

TEST_F(BadInput, PlaceForAPageOrGraphThatIsNotThere) {
  const std::string folder = place.at("nowhere");
  const std::string complaint_end =
      ": cannot be written, for there is no folder " + folder + "; make it first\n";
  for (const std::string name : {"/loop.svg", "/loop.dot"}) {
    EXPECT_EQ(complaint({"graph", place.at(collision), "--out", folder + name}),
              "error: " + folder + name + complaint_end);
  }
  EXPECT_EQ(complaint({"report", place.at("out/run.h5"), "--out", folder + "/page.html"}),
            "error: " + folder + "/page.html" + complaint_end);
}

TEST_F(BadInput, ResultThatWouldReplaceWhatItIsMadeFrom) {
  const std::string recording = place.at("out/run.h5"), same_recording = place.at("out/../out/run.h5");
  const std::string page = place.at("out/report.html");
  const std::vector<std::vector<std::string>> calls = {
      {"report", recording, "--out", same_recording},
      {"calibrate", "thresholds", page, recording, "--out", same_recording},
      {"calibrate", "dynamics", recording, "--out", same_recording},
      {"calibrate", "torque-constant", page, "--validate", recording, "--out", same_recording},
      {"train", recording, "--out", same_recording},
      {"evaluate", page, recording, "--out", same_recording}};
  for (const std::vector<std::string>& call : calls) {
    EXPECT_EQ(complaint(call), "error: " + same_recording +
                                   ": is read by this call, which would replace it; choose another name\n")
        << testing::PrintToString(call);
  }
  EXPECT_THAT(complaint({"excite", place.at(robot), "--out", place.at(robot)}),
              HasSubstr("would replace it"));
  EXPECT_THAT(complaint({"calibrate", "dynamics", page, "--out", place.at("out/report.yaml")}),
              HasSubstr("report.html: is read by this call"))
      << "the page beside it";
}

TEST_F(BadInput, PlaceOfAResultIsTriedBeforeAnythingIsComputed) {
  const std::string there = place.at("nowhere/result.yaml");
  const std::string recording = place.at("out/run.h5");
  for (const std::vector<std::string>& call : std::vector<std::vector<std::string>>{
           {"train", recording, "-o", there},
           {"excite", place.at(robot), "--out", there},
           {"calibrate", "thresholds", recording, "--out", there},
           {"calibrate", "imu-pose", recording, "--out", there},
           {"evaluate", place.at("out/report.html"), recording, "--out", there}}) {
    EXPECT_EQ(complaint(call), "error: " + there + ": cannot be written, for there is no folder " +
                                   place.at("nowhere") + "; make it first\n");
  }
}

TEST_F(BadInput, GraphOfNoKnownKind) {
  EXPECT_EQ(
      complaint({"graph", place.at(collision), "--out", place.at("out/loop.png")}),
      "error: " + place.at("out/loop.png") + ": a graph is written as .html, .svg or .dot, not as '.png'\n");
}

TEST_F(BadInput, VerbThatNobodyKnows) {
  EXPECT_EQ(complaint({"reprot", place.at(collision)}),
            "error: 'reprot' is no verb; did you mean 'report'?\n");
  EXPECT_THAT(
      complaint({}),
      StartsWith("error: there is no verb; known are: demo, run, report, export, compare, graph, check"));
}

TEST_F(BadInput, ArgumentThatIsMissingOrTooMuch) {
  EXPECT_EQ(complaint({"run"}), "error: input is required; 'flinch run --help' shows how\n");
  EXPECT_EQ(complaint({"check", place.at(collision), "--jason"}),
            "error: '--jason' is no option of 'flinch check'; did you mean '--json'?\n");
  EXPECT_EQ(complaint({"run", place.at(collision), "--sation=dds"}),
            "error: '--sation' is no option of 'flinch run'; did you mean '--station'?\n");
  EXPECT_THAT(complaint({"calibrate", "thresholds"}),
              HasSubstr("; 'flinch calibrate thresholds --help' shows how"));
  EXPECT_EQ(complaint({"calibrate", "thresholds", "run.h5", "--rates", "1"}),
            "error: '--rates' is no option of 'flinch calibrate thresholds'; did you mean '--rate'?\n");
}

TEST_F(BadInput, NumberOfAnOptionThatIsNone) {
  for (const std::string number : {"nan", "inf", "0", "-3", "many"}) {
    EXPECT_EQ(
        complaint({"calibrate", "thresholds", place.at("out/run.h5"), "--rate", number}),
        "error: --rate: is '" + number +
            "'; it must be a number from 1e-06 to 1e+06; 'flinch calibrate thresholds --help' shows how\n");
    EXPECT_THAT(
        complaint({"excite", place.at(robot), "--out", place.at("out/a.yaml"), "--duration", number}),
        StartsWith("error: --duration: is '" + number + "'; it must be a number from 0.001 to 10000"));
  }
}

TEST_F(BadInput, OptionOfABusThatIsNotAskedFor) {
  for (const std::vector<std::string>& option : {std::vector<std::string>{"--domain", "0"},
                                                 {"--patience", "10"},
                                                 {"--priority", "80"},
                                                 {"--reset-faults"}}) {
    std::vector<std::string> call = {"run", place.at(collision), "--out", place.at("out")};
    call.insert(call.end(), option.begin(), option.end());
    EXPECT_EQ(complaint(call), "error: the options of the bus mean something only with --station dds\n")
        << option[0];
  }
}

TEST_F(BadInput, OptionOfALiveViewThatMeansNothing) {
  const std::string scenario = place.at(collision);
  EXPECT_THAT(complaint({"run", scenario, "--live=http"}),
              HasSubstr("--live: is 'http'; it must be a port from 1 "));
  EXPECT_THAT(complaint({"run", scenario, "--live=65536"}), HasSubstr("it must be a port from 1 to 65535"));
  EXPECT_THAT(complaint({"run", scenario, "--live", "--live-speed", "0"}),
              HasSubstr("a number from 0.001 to 100"));
  EXPECT_THAT(complaint({"run", scenario, "--live", "--live-wait", "nan"}),
              HasSubstr("a number from 0 to 86400"));
  EXPECT_THAT(complaint({"run", scenario, "--live-speed", "2"}),
              HasSubstr("--live-speed: means something only with"));
  EXPECT_THAT(complaint({"run", scenario, "--live-wait", "2"}),
              HasSubstr("--live-wait: means something only with"));
  EXPECT_THAT(complaint({"run", scenario, "--live", "--set", "duration_s=1,2"}),
              HasSubstr("--live: shows one run"));
  EXPECT_THAT(complaint({"run", place.at("run.h5"), "--station", "recorded", "--live"}),
              HasSubstr("--live: a recording is over"));
}

TEST_F(BadInput, SeedThatIsNoWholeNumber) {
  for (const std::string seed : {"-1", "1.5", "one", "", "1e3", "0x10", "18446744073709551616"}) {
    EXPECT_EQ(complaint({"run", place.at(collision), "--out", place.at("out"), "--seed", seed}),
              "error: --seed: is '" + seed +
                  "'; it must be a whole number between 0 and 2^64 - 1; 'flinch run --help' shows how\n");
  }
}

TEST_F(BadInput, IsToldAsOneJsonObjectToPrograms) {
  place.replace(collision, "seed: 1\n", "seed: 1\nseed: 2\n");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"run", place.at(collision), "--json"}, {"check", "--json"}}) {
    const Outcome outcome = flinch(arguments);
    EXPECT_EQ(outcome.status, 2);
    const auto said = nlohmann::json::parse(outcome.out);
    ASSERT_EQ(said["error"].size(), 1U);
    EXPECT_EQ("error: " + said["error"][0].get<std::string>() + "\n", outcome.err);
  }
}

TEST_F(BadInput, NamesThatAreNoUtf8AreToldToProgramsToo) {
  const Outcome outcome = flinch({"check", place.at("caf\xe9.yaml"), "--json"});
  EXPECT_EQ(outcome.status, 2);
  const auto said = nlohmann::json::parse(outcome.out);
  EXPECT_THAT(said["error"][0].get<std::string>(), HasSubstr("caf\xef\xbf\xbd.yaml: no such file"));
}

}  // namespace
}  // namespace flinch
