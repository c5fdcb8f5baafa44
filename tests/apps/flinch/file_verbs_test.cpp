// flinch check, and report, of each kind of file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/flinch/documented_keys.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::flinch;
using test::Outcome;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class FileVerbs : public ::testing::Test {
 protected:
  /// What check says behind the name of the file.
  std::string said_of(const std::string& file) const {
    const Outcome outcome = flinch({"check", file});
    const std::string said = outcome.out + outcome.err;
    const std::size_t name = said.find(file);
    return name == std::string::npos ? said : said.substr(name + file.size());
  }

  /// A log of a five-bar and its mapping.
  std::string mapping() const {
    place.write("log.csv", "t,q0,q1,i0,i1\n0,10,20,1,2\n0.001,10.1,20,1,2\n0.002,10.2,20,1,2\n");
    std::string text =
        "csv: log.csv\nscenario: scenarios/five_bar_collision.yaml\ntime: {column: t, unit: s}\ncolumns:\n";
    for (const std::string n : {"0", "1"}) {
      text += "  - {column: q" + n + ", signal: joints.active, entry: " + n + ", unit: deg}\n";
      text += "  - {column: i" + n + ", signal: drives.current, entry: " + n + ", unit: A}\n";
    }
    place.write("mapping.yaml", text);
    return place.at("mapping.yaml");
  }

  test::Workplace place;
};

TEST_F(FileVerbs, CheckManyFilesAndTellAllThatIsWrongWithThem) {
  const std::string good = place.at("scenarios/square.yaml"), robot = place.at("robots/five_bar.yaml");
  const Outcome fine = flinch({"check", good, robot});
  EXPECT_EQ(fine.status, 0) << fine.err;
  EXPECT_THAT(fine.out,
              ::testing::StartsWith(good + ": a good scenario file\n" + robot + ": a good robot file\n"));
  const auto json = nlohmann::json::parse(flinch({"check", good, robot, "--json"}).out);
  ASSERT_EQ(json.at("files").size(), 2U);
  EXPECT_EQ(json["files"][1]["kind"], "robot");
  EXPECT_THAT(test::undocumented_keys(json, "JSON"), ::testing::IsEmpty());
  place.write("one.yaml", "robt: x\n");
  place.write("two.yaml", "kind: delta\n");
  const Outcome wrong = flinch({"check", place.at("one.yaml"), good, place.at("two.yaml")});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, AllOf(HasSubstr("one.yaml"), HasSubstr("two.yaml")));
  EXPECT_EQ(wrong.out, good + ": a good scenario file\n");
}

TEST_F(FileVerbs, CheckAMappingAndWhatIsImportedByIt) {
  EXPECT_EQ(said_of(mapping()), ": a good import mapping file\n");
  const std::string imported = place.at("imported.h5");
  const Outcome outcome = flinch({"import", mapping(), "--out", imported, "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(test::undocumented_keys(nlohmann::json::parse(outcome.out), "JSON"), ElementsAre());
  EXPECT_EQ(said_of(imported), ": a good readings file, for flinch calibrate\n");
  for (const std::vector<std::string>& call :
       {std::vector<std::string>{"report", imported, "--out", place.at("page.html")},
        {"run", imported, "--station", "recorded", "--out", place.at("again")}})
    EXPECT_THAT(flinch(call).err, HasSubstr("imported.h5: holds readings and no run; 'flinch judge'"))
        << call[0];
  EXPECT_THAT(flinch({"calibrate", "thresholds", imported}).err,
              HasSubstr("of motion with valid estimates are recorded"));
  EXPECT_THAT(flinch({"calibrate", "thresholds", imported, "--free", "a..b"}).err,
              HasSubstr("--free: is 'a..b'; it must be two times in s"));
  place.replace("mapping.yaml", "unit: deg", "unit: A");
  EXPECT_THAT(said_of(place.at("mapping.yaml")), HasSubstr("unit"));
}

TEST_F(FileVerbs, CheckEveryRowOfARecording) {
  flinch({"run", place.at("scenarios/platform_collision.yaml"), "--set", "duration_s=0.4", "--out",
          place.at("out"), "--quiet"});
  const std::string file = place.at("out/run.h5");
  ASSERT_EQ(said_of(file), ": a good recording file\n");
  // In the middle of the file are rows of the largest signals; a page and a verdict need few of them.
  const std::string whole = test::bytes_of(place / "out/run.h5");
  for (const std::size_t share : {2U, 3U, 4U}) {
    std::string broken = whole;
    broken.replace(broken.size() / 5 * share, 2000, 2000, '\0');
    place.write("broken.h5", broken);
    EXPECT_EQ(flinch({"check", place.at("broken.h5")}).status, 2) << share << " fifths";
  }
}

TEST_F(FileVerbs, KnowTheResultsOfACampaign) {
  place.write("campaigns/one.yaml", "scenario: ../scenarios/platform_collision.yaml\nruns: 1\n");
  ASSERT_EQ(flinch({"campaign", place.at("campaigns/one.yaml"), "--out", place.at("out"), "--quiet"}).status,
            0);
  EXPECT_EQ(said_of(place.at("out/results.h5")),
            ": a good campaign results file, by what it says it is; its columns were not read\n");
  EXPECT_EQ(
      flinch({"report", place.at("out/results.h5")}).err,
      "error: " + place.at("out/results.h5") + ": is no recording; it says that it is 'flinch campaign'\n");
}

TEST_F(FileVerbs, SayOfWhatKindAFileIsThatIsNotWanted) {
  const std::string scenario = place.at("scenarios/platform_collision.yaml");
  const std::string robot = place.at("robots/planar_3rrr.yaml");
  for (const std::string verb : {"run", "graph"})
    EXPECT_THAT(flinch({verb, robot}).err, HasSubstr(": is a robot file, not a scenario; ")) << verb;
  EXPECT_THAT(flinch({"campaign", scenario}).err, HasSubstr(": is a scenario, not a campaign; 'flinch run'"));
  EXPECT_THAT(flinch({"import", scenario, "--out", place.at("out.h5")}).err,
              HasSubstr(": is a scenario, not "));
  place.replace("scenarios/platform_collision.yaml", "robot: ../robots/planar_3rrr.yaml",
                "robot: stiffness.yaml");
  const Outcome outcome = flinch({"check", scenario});
  EXPECT_THAT(outcome.err, HasSubstr("stiffness.yaml:"));
  EXPECT_THAT(outcome.err, HasSubstr(": is a scenario, not a robot file; 'flinch run' runs it"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("is not a known key")));
}

#if FLINCH_HAS_LEARNING
TEST_F(FileVerbs, CheckClassifiersAndWhatMakesTheirData) {
  EXPECT_EQ(said_of(FLINCH_SOURCE_DIR "/apps/models/bodies.onnx"), ": a good classifier file\n");
  EXPECT_EQ(said_of(FLINCH_SOURCE_DIR "/apps/models/papers.yaml"), ": a good data specification file\n");
  EXPECT_EQ(said_of(FLINCH_SOURCE_DIR "/apps/papers/papers.yaml"), ": a good figures file\n");
  place.write("broken.onnx", "\\");
  EXPECT_THAT(said_of(place.at("broken.onnx")), HasSubstr("ONNX"));
  place.write("data.yaml", "contacts: []\nseet: 1\n");
  EXPECT_THAT(said_of(place.at("data.yaml")), HasSubstr("seet: is not a known key; did you mean 'seed'"));
  const std::string data = place.at("data.h5");
  const Outcome made = flinch(
      {"dataset", FLINCH_SOURCE_DIR "/apps/models/papers.yaml", "--runs", "1", "--out", data, "--json"});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(test::undocumented_keys(nlohmann::json::parse(made.out), "JSON"), ElementsAre());
  EXPECT_EQ(said_of(data), ": a good data set file\n");
  ASSERT_EQ(
      flinch({"run", place.at("scenarios/platform_collision.yaml"), "--out", place.at("out"), "--quiet"})
          .status,
      0);
  const std::string recording = place.at("out/run.h5");
  EXPECT_EQ(flinch({"train", recording, "-o", place.at("model.onnx")}).err,
            "error: " + recording + ": this is no data set of contacts; 'flinch dataset' makes one\n");
}
#endif

}  // namespace
}  // namespace flinch
