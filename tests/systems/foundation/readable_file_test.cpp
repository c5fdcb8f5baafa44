#include "systems/foundation/readable_file.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

namespace flinch {
namespace {

namespace fs = std::filesystem;

class AFileToBeRead : public testing::Test {
 protected:
  const test::TemporaryFolder folder;
};

TEST_F(AFileToBeRead, IsThereAndHasBytes) {
  std::ofstream(folder / "some") << "text";
  std::ofstream(folder / "empty") << "";
  EXPECT_EQ(problem_with_reading(folder / "some"), "");
  EXPECT_EQ(problem_with_reading(folder / "empty"), "is empty");
  EXPECT_EQ(problem_with_reading(folder / "none"), "there is no such file");
  EXPECT_EQ(problem_with_reading(folder / "some/below"), "there is no such file");
  EXPECT_EQ(problem_with_reading(folder.path()), "is a folder; it must be a file");
}

TEST_F(AFileToBeRead, IsNeitherPipeNorDeviceNorFileOfTheKernel) {
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", folder / "link");
  for (const fs::path& file : {folder / "pipe", folder / "link", fs::path("/dev/zero")})
    EXPECT_EQ(problem_with_reading(file), "is no regular file; it must be one") << file;
  fs::create_symlink("loop", folder / "loop");
  EXPECT_EQ(problem_with_reading(folder / "loop"), "cannot be read: Too many levels of symbolic links");
  EXPECT_EQ(problem_with_reading("/proc/version"), "is empty") << "so says it itself";
}

}  // namespace
}  // namespace flinch
