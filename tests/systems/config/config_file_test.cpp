#include "systems/config/config_file.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <chrono>

#include "tests/support/temporary_folder.h"
#include "tests/systems/config/problems_of.h"

namespace flinch {
namespace {

using test::Problems;
using test::problems_of;
using test::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::EndsWith;

Problems problems_of_file(const std::filesystem::path& file) {
  return problems_of([&] { read_config_file(file); });
}

TEST(ReadingAFile, GivesItsTextAsItIs) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_config_file(folder.write("a.yaml", "a: 1\r\n\n")), "a: 1\r\n\n");
}

TEST(MissingFile, IsToldWithTheNearestNameInItsFolder) {
  const TemporaryFolder folder;
  folder.write("planar_3rrr.yaml", "");
  folder.write("hexapod.yml", "");
  folder.write("planar_3rr.txt", "");
  EXPECT_THAT(problems_of_file(folder / "planar_3rr.yaml"),
              ElementsAre((folder / "planar_3rr.yaml").string() +
                          ": no such file; did you mean 'planar_3rrr.yaml'?"));
  EXPECT_THAT(problems_of_file(folder / "hexpod.yaml"), ElementsAre(EndsWith("did you mean 'hexapod.yml'?")));
}

TEST(MissingFile, IsToldWithAllThatAreThereIfNoneIsNear) {
  const TemporaryFolder folder;
  EXPECT_THAT(problems_of_file(folder / "delta.yaml"), ElementsAre(EndsWith("no such file")));
  folder.write("planar_3rrr.yaml", "");
  folder.write("hexapod.yml", "");
  EXPECT_THAT(problems_of_file(folder / "scara.yaml"),
              ElementsAre(EndsWith("no such file; its folder has hexapod.yml, planar_3rrr.yaml")));
}

TEST(MissingFile, MayMissItsFolderToo) {
  const TemporaryFolder folder;
  EXPECT_THAT(problems_of_file(folder / "robots/a.yaml"),
              ElementsAre(EndsWith("no such file, for there is no folder " + (folder / "robots").string())));
}

TEST(UnreadableFile, IsRefused) {
  const TemporaryFolder folder;
  EXPECT_THAT(problems_of_file(folder / ""), ElementsAre(EndsWith(": is a folder; it must be a file")));
  EXPECT_THAT(problems_of_file("/dev/zero"), ElementsAre("/dev/zero: is no regular file; it must be one"));
  const std::string hdf5 = folder.write("run.h5", "\x89HDF\r\n").string();
  EXPECT_THAT(problems_of_file(hdf5),
              ElementsAre(hdf5 + ": is an HDF5 file, such as a recording; it must be YAML"));
  const std::string network = folder.write("net.onnx", std::string("a: \0b", 5)).string();
  EXPECT_THAT(problems_of_file(network), ElementsAre(network + ": is no text; it must be YAML"));
  EXPECT_THAT(problems_of_file(""),
              ElementsAre(EndsWith("the name is empty; it must be the name of a file")));
}

TEST(UnreadableFile, IsToldWithTheReasonOfTheSystem) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("loop.yaml", folder / "loop.yaml");
  EXPECT_THAT(problems_of_file((folder / "loop.yaml").string()),
              ElementsAre(EndsWith("loop.yaml: cannot be read: Too many levels of symbolic links")));
}

TEST(UnreadableFile, MayKeepItsReaderWaiting) {
  if (!std::ifstream("/proc/kmsg")) GTEST_SKIP() << "only root may read the messages of the kernel";
  const auto begin = std::chrono::steady_clock::now();
  try {
    read_config_file("/proc/kmsg");  // all there is, or that there is nothing now
  } catch (const SetupError&) {
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(UnreadableFile, MayBeTooLarge) {
  const TemporaryFolder folder;
  EXPECT_TRUE(problems_of_file(folder.write("a.yaml", std::string(1'000'000, '#'))).empty());
  EXPECT_THAT(problems_of_file(folder.write("a.yaml", std::string(1'000'001, '#'))),
              ElementsAre(EndsWith("has more than 1000000 bytes; a file of settings has fewer")));
}

}  // namespace
}  // namespace flinch
