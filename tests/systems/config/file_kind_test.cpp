#include "systems/config/file_kind.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/systems/config/problems_of.h"

namespace flinch {
namespace {

using test::Problems;
using test::problems_of;
using test::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::map<FileKind, std::string> examples = {
    {FileKind::parameters, "flinch_calibration: 1\nkind: imu-pose\nrobot: {file: a}\nrecordings: []\n"},
    {FileKind::mapping, "csv: log.csv\nscenario: a.yaml\ncolumns: []\n"},
    {FileKind::scenario, "robot: a.yaml\nduration_s: 1\n"},
    {FileKind::campaign, "scenario: a.yaml\nruns: 2\n"},
    {FileKind::robot, "kind: planar_3rrr\nlegs: []\n"},
    {FileKind::data_spec, "contacts: []\n"},
    {FileKind::figures, "figures: []\n"}};

Problems problems_as(FileKind wanted, const std::string& text) {
  return problems_of([&] { require_kind(ConfigReader::parse(text, "a.yaml"), wanted); });
}

TEST(FileKinds, AreToldByTheirKeys) {
  const TemporaryFolder folder;
  for (const auto& [kind, text] : examples) EXPECT_EQ(kind_of(folder.write("a.yaml", text)), kind) << text;
  EXPECT_EQ(kind_of(folder.write("a.yaml", "seed: 1\n")), std::nullopt);
  EXPECT_EQ(kind_of(folder.write("a.yaml", "recordings: []\n")), FileKind::data_spec);
  EXPECT_EQ(kind_of(folder.write("a.yaml", "legs: []\n")), FileKind::robot) << "whose kind was forgotten";
}

TEST(FileKinds, OfAllFilesThatAreHereAreThoseOfTheirFolders) {
  const std::filesystem::path apps = FLINCH_SOURCE_DIR "/apps";
  for (const auto& [folder, kind] : {std::pair("robots", FileKind::robot),
                                     {"scenarios", FileKind::scenario},
                                     {"calibrations", FileKind::parameters},
                                     {"campaigns", FileKind::campaign},
                                     {"models", FileKind::data_spec}}) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(apps / folder)) {
      if (entry.path().extension() != ".yaml") continue;
      EXPECT_EQ(kind_of(entry.path()), kind) << entry.path();
      ++files;
    }
    EXPECT_GT(files, 0) << folder;
  }
}

TEST(FileKinds, ThatAreNotWantedAreToldInOneLine) {
  for (const auto& [kind, text] : examples) {
    for (const auto& [wanted, other] : examples) {
      if (wanted == kind) {
        EXPECT_THAT(problems_as(wanted, text), IsEmpty()) << text;
      } else {
        EXPECT_EQ(problems_as(wanted, text).size(), 1U) << text << other;
      }
    }
  }
  EXPECT_THAT(problems_as(FileKind::scenario, examples.at(FileKind::robot)),
              ElementsAre("a.yaml:1: is a robot file, not a scenario; scenarios name it as 'robot'"));
  EXPECT_THAT(problems_as(FileKind::scenario, examples.at(FileKind::campaign)),
              ElementsAre("a.yaml:1: is a campaign, not a scenario; 'flinch campaign' runs it"));
  EXPECT_THAT(problems_as(FileKind::robot, examples.at(FileKind::scenario)),
              ElementsAre("a.yaml:1: is a scenario, not a robot file; 'flinch run' runs it"));
}

TEST(FileKinds, AreLeftToTheReaderInDoubt) {
  EXPECT_THAT(problems_as(FileKind::scenario, "duration_s: 1\n"), IsEmpty()) << "it may lack its robot";
  for (const FileKind wanted : {FileKind::scenario, FileKind::campaign})
    EXPECT_THAT(problems_as(wanted, "robot: a.yaml\nscenario: b.yaml\n"), IsEmpty()) << "one key is too many";
}

TEST(FileKinds, OfferNoKeysToWhoMisspells) {
  EXPECT_THAT(
      problems_of("legz: 1\n", [](ConfigReader& reader) { require_kind(reader, FileKind::scenario); }),
      ElementsAre("a.yaml:1: legz: is not a known key"));
}

}  // namespace
}  // namespace flinch
