#include "apps/flinch/shipped_files.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;

/// The working directory is a folder of its own meanwhile.
class ShippedFiles : public testing::Test {
 protected:
  ShippedFiles() { fs::current_path(folder_.path()); }
  ~ShippedFiles() override { fs::current_path(before_); }

 private:
  fs::path before_ = fs::current_path();
  test::TemporaryFolder folder_;
};

TEST_F(ShippedFiles, AreFoundByTheirNames) {
  if (shipped_folder().empty()) GTEST_SKIP() << "none come with this program";
  const fs::path found = or_shipped("platform_collision", "scenarios");
  EXPECT_EQ(found, shipped_folder() / "scenarios/platform_collision.yaml");
  EXPECT_EQ(or_shipped("platform_collision.yaml", "scenarios"), found);
}

TEST_F(ShippedFiles, AreNotHiddenByAFolderOfTheirName) {
  if (shipped_folder().empty()) GTEST_SKIP() << "none come with this program";
  fs::create_directory("papers");
  EXPECT_EQ(or_shipped("papers", "papers"), shipped_folder() / "papers/papers.yaml");
  fs::create_directory("own");
  EXPECT_EQ(or_shipped("own", "papers"), "own") << "that it is a folder is what is wrong";
}

}  // namespace
}  // namespace flinch
