#include "systems/foundation/readable_file.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

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

TEST_F(AFileToBeRead, IsPermitted) {
  fs::permissions(folder.write("secret", "text"), fs::perms::none);
  const bool is_root = ::geteuid() == 0;  // to whom everything is permitted
  if (is_root && ::seteuid(65534) != 0) GTEST_SKIP() << "cannot become another user";
  const std::string problem = problem_with_reading(folder / "secret");
  ASSERT_TRUE(!is_root || ::seteuid(0) == 0);
  EXPECT_EQ(problem, "cannot be opened; reading it must be permitted");
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

TEST_F(AFileToBeRead, HasANameThatDoesNotEndBefore) {
  const fs::path name = folder.path().string() + std::string("/some\0.yaml", 11);
  std::ofstream(folder / "some") << "text";
  EXPECT_EQ(problem_with_reading(name),
            "has a character 0 in its name, at which the system ends names; leave it out");
  EXPECT_EQ(problem_with_name(folder / "some"), "");
}

}  // namespace
}  // namespace flinch
