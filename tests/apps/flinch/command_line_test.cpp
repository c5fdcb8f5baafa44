// The program from its command line to its files.
#include "apps/flinch/command_line.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "systems/framework/recording.h"
#include "tests/apps/flinch/documented_keys.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/same_signals.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using nlohmann::json;
using test::flinch;
using test::Outcome;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* collision = "scenarios/platform_collision.yaml";
const std::vector<std::string> verbs = {"run", "report", "graph", "check", "campaign"};

class CommandLine : public ::testing::Test {
 protected:
  Outcome run(const std::string& scenario, const std::vector<std::string>& options = {}) const {
    std::vector<std::string> arguments = {"run", place.at(scenario), "--out", place.at("out")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return flinch(arguments);
  }
  std::string bytes_of(const std::string& name) const { return test::bytes_of(place / name); }

  test::Workplace place;
};

// ---------------------------------------------------------------- what is printed

TEST_F(CommandLine, FailsWhereItsOutputIsLost) {
  const std::string scenario = place.at(collision);
  const std::vector<const char*> arguments = {"flinch", "check", scenario.c_str(), "--json"};
  std::fflush(stdout);
  const int before = ::dup(STDOUT_FILENO);
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  ::dup2(full, STDOUT_FILENO);
  ::testing::internal::CaptureStderr();
  const int status = run_command_line(static_cast<int>(arguments.size()), arguments.data());
  const std::string told = ::testing::internal::GetCapturedStderr();
  std::clearerr(stdout);
  ::dup2(before, STDOUT_FILENO);
  ::close(full);
  ::close(before);
  EXPECT_EQ(status, 2);
  EXPECT_THAT(told, HasSubstr("what was to be printed cannot be written: No space left on device"));
}

TEST_F(CommandLine, IsKeptSoThatAShellTakesItAgain) {
  const std::string out = place.at("my results");
  flinch({"run", place.at(collision), "--set", "duration_s=0.3", "--set",
          "control.momentum_observer.gain_per_s=[20, 20, 20]", "--out", out, "--quiet"});
  EXPECT_THAT(
      read_recording(place / "my results/run.h5").attributes.at("command_line"),
      HasSubstr("--set duration_s=0.3 --set 'control.momentum_observer.gain_per_s=[20, 20, 20]' --out '" +
                out + "' --quiet"));
}

// ---------------------------------------------------------------- values of keys

TEST_F(CommandLine, SetsKeysOfTheScenarioAsAFileWouldHaveThem) {
  EXPECT_EQ(run(collision, {"--set", "duration_s=0.4", "--set", "pylon.radius_mm=30", "--json"}).status, 1);
  const Recording set = read_recording(place / "out/run.h5");
  place.replace(collision, "duration_s: 1.2", "duration_s: 0.4");
  place.replace(collision, "radius_mm: 40", "radius_mm: 30");
  EXPECT_EQ(run(collision).status, 1);
  const Recording written = read_recording(place / "out/run.h5");
  ASSERT_EQ(set.signals.size(), written.signals.size());
  ASSERT_EQ(set.samples(), 400U);
  for (const Signal& signal : set.signals) {
    EXPECT_FALSE(signal.rows.empty()) << signal.path;
    EXPECT_TRUE(test::is_same(set, written, signal.path)) << signal.path;
  }
  // What the recording keeps is enough to repeat the run.
  place.write("scenarios/again.yaml", set.attributes.at("scenario.text"));
  EXPECT_EQ(run("scenarios/again.yaml").status, 1);
  EXPECT_EQ(read_recording(place / "out/run.h5").signals.size(), set.signals.size());
}

TEST_F(CommandLine, SaysOfEachValueThatIsSetWhatIsWrongWithIt) {
  const Outcome outcome =
      run(collision, {"--set", "duration_s=1,2", "--set", "pylon", "--set", "robot.x=3", "--set", "a= "});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("--set pylon: is not of the form KEY=VALUE"),
                                 HasSubstr("--set robot.x=3: "), HasSubstr("--set a= : gives no value")));
  const Outcome unknown = run(collision, {"--set", "pylon.radios_mm=30"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(
      unknown.err,
      HasSubstr("--set pylon.radios_mm=30: pylon.radios_mm: is not a known key; did you mean 'radius_m'?"));
  EXPECT_FALSE(std::filesystem::exists(place / "out"));
}

// ---------------------------------------------------------------- exit status

TEST_F(CommandLine, Ends0WhereTheVerdictIsGood) {
  const Outcome outcome = run(collision);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("verdict: good\n"));
}

TEST_F(CommandLine, Ends0WhereTheRobotIsBroughtBackAsExpected) {
  const Outcome outcome = run("scenarios/brought_back.yaml");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("verdict: good, but\n  - the torque gate closed: "));
}

TEST_F(CommandLine, Ends1WhereTheVerdictIsBadAndStillWritesEverything) {
  place.replace(collision, "detection_time_ms: 15", "detection_time_ms: 1");
  const Outcome outcome = run(collision);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("verdict: bad\n  - the contact with platform was detected after"));
  EXPECT_FALSE(bytes_of("out/run.h5").empty());
  EXPECT_FALSE(bytes_of("out/report.html").empty());
}

TEST_F(CommandLine, Ends3WhereAFaultClosesTheTorqueGate) {
  place.write("scenarios/fault.yaml",
              "robot: ../robots/planar_3rrr.yaml\nduration_s: 1\n"
              "motion: {kind: through, poses: [{x_mm: 0}, {x_mm: 360}]}\n");
  const Outcome outcome = run("scenarios/fault.yaml");
  EXPECT_EQ(outcome.status, 3) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("verdict: bad\n  - the torque gate closed: "));
}

// ---------------------------------------------------------------- what it prints

TEST_F(CommandLine, PrintsResultsOnStdoutAndMessagesOnStderr) {
  const Outcome outcome = run(collision);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("contact with"), HasSubstr("platform"), HasSubstr("seed 1")));
  EXPECT_THAT(outcome.out, Not(HasSubstr("run.h5")));
  std::string quarters;
  for (const char* const share : {"25", "50", "75"})
    quarters += std::string("simulating platform_collision: ") + share + " %, [0-9.]+ s left\n";
  EXPECT_THAT(outcome.err, MatchesRegex(quarters + "recording: " + place.at("out/run.h5") +
                                        "\nreport:    " + place.at("out/report.html") + "\n"));
}

TEST_F(CommandLine, PrintsOnlyResultsWhenQuiet) {
  const Outcome outcome = run(collision, {"--quiet"});
  EXPECT_THAT(outcome.out, HasSubstr("verdict: good\n"));
  EXPECT_EQ(outcome.err, "");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"check", place.at(collision), "--quiet"},
        {"report", place.at("out/run.h5"), "--quiet"},
        {"graph", place.at(collision), "--quiet", "--out", place.at("loop.dot")}}) {
    const Outcome quiet = flinch(arguments);
    EXPECT_EQ(quiet.status, 0);
    EXPECT_EQ(quiet.out + quiet.err, "");
  }
}

TEST_F(CommandLine, PrintsOneJsonObjectWithTheWholeVerdict) {
  const Outcome outcome = run(collision, {"--json", "--seed", "5"});
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1);
  const json verdict = json::parse(outcome.out);
  for (const std::string key : {"max_observer_error_N", "max_observer_error_Nm", "max_tracking_error_mm",
                                "loop_closure_m", "simulated_s", "wall_s"}) {
    EXPECT_TRUE(verdict.at(key).is_number_float()) << key;
  }
  EXPECT_EQ(verdict.at("verdict"), "good");
  EXPECT_EQ(verdict.at("false_detections"), 0);
  EXPECT_EQ(verdict.at("seed"), 5);
  EXPECT_EQ(verdict.at("simulated_s"), 1.2);

  ASSERT_EQ(verdict.at("contacts").size(), 1U);
  const json& contact = verdict["contacts"][0];
  EXPECT_EQ(contact.at("body"), "platform");
  EXPECT_EQ(contact.at("detected"), true);
  EXPECT_EQ(contact.at("within_limit"), true);
  for (const std::string key : {"detection_ms", "removal_ms", "peak_force_N", "limit_N"}) {
    EXPECT_TRUE(contact.at(key).is_number()) << key;
  }
}

TEST_F(CommandLine, PrintsNullInJsonForWhatDidNotHappen) {
  place.replace("scenarios/clamping.yaml", "duration_s: 1.5", "duration_s: 0.48");
  const json contact = json::parse(run("scenarios/clamping.yaml", {"--json"}).out).at("contacts").at(0);
  EXPECT_EQ(contact.at("detected"), false);
  EXPECT_TRUE(contact.at("detection_ms").is_null());
  EXPECT_TRUE(contact.at("removal_ms").is_null());
}

TEST_F(CommandLine, PrintsOneJsonObjectForEveryVerb) {
  run(collision);
  EXPECT_EQ(json::parse(flinch({"check", place.at(collision), "--json"}).out),
            json({{"file", place.at(collision)},
                  {"kind", "scenario"},
                  {"good", true},
                  {"warnings", json::array()}}));
  EXPECT_EQ(json::parse(flinch({"report", place.at("out/run.h5"), "--json"}).out),
            json({{"report", place.at("out/report.html")}}));
  EXPECT_EQ(json::parse(flinch({"graph", place.at(collision), "--out", place.at("loop.svg"), "--json"}).out),
            json({{"graph", place.at("loop.svg")}}));
  EXPECT_THAT(json::parse(flinch({"graph", place.at(collision), "--json"}).out).at("dot").get<std::string>(),
              StartsWith("digraph"));
}

TEST_F(CommandLine, HelpsWithAnExampleOfEveryVerb) {
  const Outcome help = flinch({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.out, HasSubstr("Exit status: 0 done, 1 verdict or link failed, 2 bad input or "
                                  "usage,\n3 a fault"));
  for (const std::string& verb : verbs) {
    EXPECT_THAT(help.out, HasSubstr("  " + verb + " "));
    const Outcome of_verb = flinch({verb, "--help"});
    EXPECT_EQ(of_verb.status, 0);
    EXPECT_EQ(of_verb.err, "");
    EXPECT_THAT(of_verb.out, HasSubstr("Example:\n  flinch " + verb + " "));
    for (const std::string option : {"--json", "--quiet"}) EXPECT_THAT(of_verb.out, HasSubstr(option));
    for (const std::string clutter : {"POSITIVE", " in [0"})
      EXPECT_THAT(of_verb.out, Not(HasSubstr(clutter)));
  }
}

TEST_F(CommandLine, HelpsWithinEightyColumnsButForExamples) {
  for (const std::string& verb : verbs) {
    const std::string help = flinch({verb, "--help"}).out;
    std::istringstream lines(help.substr(0, help.find("Example:\n")));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << verb << ": " << line;
  }
}

TEST_F(CommandLine, HelpsAlsoByAVerb) {
  EXPECT_EQ(flinch({"help", "run"}).out, flinch({"run", "--help"}).out);
  EXPECT_EQ(flinch({"help", "calibrate", "dynamics"}).out, flinch({"calibrate", "dynamics", "--help"}).out);
  EXPECT_EQ(flinch({"help"}).out, flinch({"--help"}).out);
  const Outcome wrong = flinch({"help", "rnu"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_EQ(wrong.err, "error: 'rnu' is no verb; did you mean 'run'?\n");
}

TEST_F(CommandLine, TellsItsVersion) {
  const Outcome outcome = flinch({"--version"});
  EXPECT_EQ(outcome.status, 0);
  const std::string number = "[0-9]+\\.[0-9]+\\.[0-9]+", of_commit = "( \\([0-9a-f]+(-dirty)?\\))?";
  EXPECT_THAT(outcome.out, ::testing::MatchesRegex("flinch " + number + of_commit + "\n"));
}

// ---------------------------------------------------------------- what it writes

TEST_F(CommandLine, WritesTheSameBytesAgain) {
  run(collision);
  const std::string recording = bytes_of("out/run.h5");
  const std::string page = bytes_of("out/report.html");
  std::this_thread::sleep_for(1100ms);  // HDF5 would keep times in whole seconds
  run(collision);
  EXPECT_TRUE(bytes_of("out/run.h5") == recording);
  EXPECT_TRUE(bytes_of("out/report.html") == page);
}

TEST_F(CommandLine, WritesTheSameDataElsewhereWithTheCommandThatMadeIt) {
  run(collision);
  flinch({"run", place.at(collision), "--out", place.at("elsewhere"), "--quiet"});
  Recording here = read_recording(place / "out/run.h5");
  Recording there = read_recording(place / "elsewhere/run.h5");
  EXPECT_EQ(here.attributes.at("command_line"),
            "flinch run " + place.at(collision) + " --out " + place.at("out"));
  EXPECT_EQ(there.attributes.at("command_line"),
            "flinch run " + place.at(collision) + " --out " + place.at("elsewhere") + " --quiet");

  there.attributes["command_line"] = here.attributes["command_line"];
  write_recording(there, place / "elsewhere/run.h5");
  EXPECT_TRUE(bytes_of("elsewhere/run.h5") == bytes_of("out/run.h5"));
}

TEST_F(CommandLine, WritesOtherDataForAnotherSeed) {
  run(collision, {"--seed", "1"});
  const Recording one = read_recording(place / "out/run.h5");
  run(collision, {"--seed", "2"});
  const Recording two = read_recording(place / "out/run.h5");
  EXPECT_EQ(two.attributes.at("seed"), "2");
  EXPECT_NE(one.column("joints", "active"), two.column("joints", "active"));
}

TEST_F(CommandLine, SaysInTheRecordingWhatMadeIt) {
  run(collision, {"--seed", "9"});
  const Recording recording = read_recording(place / "out/run.h5");
  EXPECT_EQ(recording.period, 1ms);
  EXPECT_EQ(recording.samples(), 1200U);
  EXPECT_EQ(recording.attributes.at("seed"), "9");
  EXPECT_EQ(recording.attributes.at("scenario.file"), "platform_collision.yaml");
  EXPECT_EQ(recording.attributes.at("scenario.text"), bytes_of(collision));
  EXPECT_EQ(recording.attributes.at("robot.text"), bytes_of("robots/planar_3rrr.yaml"));
  EXPECT_THAT(flinch({"--version"}).out, StartsWith("flinch " + recording.attributes.at("flinch.version")));
}

TEST_F(CommandLine, MakesTheSamePageFromARecordingAsTheRun) {
  run(collision, {"--seed", "9"});
  const Outcome outcome = flinch({"report", place.at("out/run.h5"), "--out", place.at("again.html")});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, "report: " + place.at("again.html") + "\n");
  EXPECT_TRUE(bytes_of("again.html") == bytes_of("out/report.html"));
}

TEST_F(CommandLine, MakesThePageWithoutTheFilesOfTheScenario) {
  run(collision);
  std::filesystem::remove_all(place / "scenarios");
  std::filesystem::remove_all(place / "robots");
  std::filesystem::rename(place / "out", place / "moved");
  const std::string page = bytes_of("moved/report.html");
  std::filesystem::remove(place / "moved/report.html");
  EXPECT_EQ(flinch({"report", place.at("moved/run.h5")}).status, 0);
  EXPECT_TRUE(bytes_of("moved/report.html") == page);
}

TEST_F(CommandLine, ShowsInThePageTheSeedThatTookEffect) {
  run(collision, {"--seed", "123456789"});
  EXPECT_THAT(bytes_of("out/report.html"), HasSubstr("\"from the command line\""));
  EXPECT_THAT(bytes_of("out/report.html"), HasSubstr("\"123456789\""));
}

TEST_F(CommandLine, DrawsTheClosedLoopAsDotOrSvg) {
  const std::string dot = flinch({"graph", place.at(collision)}).out;
  EXPECT_THAT(dot, AllOf(StartsWith("digraph"), HasSubstr("station"), HasSubstr("torque_gate")));
  EXPECT_EQ(flinch({"graph", place.at(collision), "--out", place.at("loop.dot")}).status, 0);
  EXPECT_EQ(bytes_of("loop.dot"), dot);

  const Outcome outcome = flinch({"graph", place.at(collision), "--out", place.at("it's a loop.svg")});
  EXPECT_EQ(outcome.out, "graph: " + place.at("it's a loop.svg") + "\n");
  EXPECT_THAT(bytes_of("it's a loop.svg"), AllOf(HasSubstr("<svg"), HasSubstr("</svg>")));
  for (const auto& [file, bytes] : place.contents()) EXPECT_THAT(file, Not(HasSubstr(".part")));
}

TEST_F(CommandLine, PrintsOnlyKeysThatTheDocumentNames) {
  EXPECT_THAT(
      test::undocumented_keys(json::parse(R"({"verdict": "good", "contacts": [{"no_key": 1}]})"), "JSON"),
      ElementsAre("contacts.no_key"));
  const json printed = json::parse(run(collision, {"--json"}).out);
  ASSERT_EQ(printed["contacts"].size(), 1U);
  EXPECT_THAT(test::undocumented_keys(printed, "JSON"), ElementsAre());
}

TEST_F(CommandLine, ChecksScenariosRobotsAndRecordings) {
  run(collision);
  EXPECT_EQ(flinch({"check", place.at(collision)}).out, place.at(collision) + ": a good scenario file\n");
  EXPECT_THAT(flinch({"check", place.at("robots/planar_3rrr.yaml")}).out,
              StartsWith(place.at("robots/planar_3rrr.yaml") + ": a good robot file\n"));
  EXPECT_EQ(flinch({"check", place.at("out/run.h5")}).out,
            place.at("out/run.h5") + ": a good recording file\n");
}

/// A threshold that counts for nobody, in a scenario and as an axis of a campaign.
TEST_F(CommandLine, WarnsOfWhatIsDoubtfulAboutCalibrations) {
  const auto warned =
      HasSubstr("warning: the scenario's control.contact_detector.reaction_force does not count for");
  const std::string campaign = "campaigns/sweep.yaml";
  place.write(
      "found.yaml",
      "flinch_calibration: 1\nkind: thresholds\ndate: '2026-11-27'\n"
      "control: {contact_detector: {by_estimator: [{estimator: momentum_observer, reaction_force_N: 9, "
      "reaction_moment_Nm: 1}]}}\n");
  place.write(campaign,
              "scenario: ../scenarios/platform_collision.yaml\n"
              "grid: [{key: calibrations, values: [[{file: ../found.yaml}]]}]\n");
  EXPECT_THAT(flinch({"check", place.at(campaign)}).err, "")
      << "calibrations that it varies are meant to replace what the scenario says";
  place.replace(campaign, "]]}]", "]]}, {key: control.contact_detector.reaction_force_N, values: [5, 10]}]");
  EXPECT_THAT(flinch({"check", place.at(campaign)}).err, warned);
  EXPECT_THAT(flinch({"campaign", place.at(campaign), "--out", place.at("sweep")}).err, warned);
  place.replace(campaign, "detector.reaction_force_N, values: [5, 10]}",
                "detector, values: [{reaction_force_N: 5}]}");
  EXPECT_THAT(flinch({"check", place.at(campaign)}).err, warned) << "by the whole section";

  place.replace(collision, "\nseed: ", "\ncalibrations: [{file: ../found.yaml}]\nseed: ");
  const Outcome checked = flinch({"check", place.at(collision)});
  EXPECT_EQ(checked.status, 0);
  EXPECT_THAT(checked.err, warned);
  EXPECT_EQ(json::parse(flinch({"check", place.at(collision), "--json"}).out).at("warnings").size(), 2U);
}

TEST_F(CommandLine, ChecksTheKeysOfACampaign) {
  const std::string few = "campaigns/few.yaml";
  place.write(
      few,
      "scenario: ../scenarios/platform_collision.yaml\nruns: 2\ndraw:\n  - {key: motion.speed_m_per_s, "
      "from: 0.5, to: 1}\n");
  EXPECT_EQ(flinch({"check", place.at(few)}).out, place.at(few) + ": a good campaign file\n");
  place.replace(few, "motion.speed", "motion.sped");
  const Outcome outcome = flinch({"check", place.at(few)});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr(place.at(few) + ":4: motion.sped_m_per_s: is not a known key; did you mean"));
}

TEST_F(CommandLine, FindsEveryShippedRobotGood) {
  for (const auto& entry : std::filesystem::directory_iterator(place / "robots")) {
    const Outcome outcome = flinch({"check", entry.path().string()});
    EXPECT_THAT(outcome.out, StartsWith(entry.path().string() + ": a good robot file\n"));
    EXPECT_EQ(outcome.err, "");
  }
}

TEST_F(CommandLine, WritesNothingWhenItChecks) {
  const auto before = place.contents();
  flinch({"check", place.at(collision)});
  EXPECT_TRUE(place.contents() == before);
}

}  // namespace
}  // namespace flinch
