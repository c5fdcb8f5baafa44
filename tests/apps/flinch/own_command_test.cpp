#include "apps/flinch/own_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// This program is these tests, so that its commands are those of GoogleTest.

TEST(OwnCommand, RunsInItsFolderAndReturnsWhatItPrints) {
  const test::TemporaryFolder folder;
  const std::string printed = run_own_command(
      {"--gtest_list_tests", "--gtest_filter=OwnCommand.*", "--gtest_output=json:listed.json"},
      folder / "new");
  EXPECT_THAT(printed, HasSubstr("RunsInItsFolderAndReturnsWhatItPrints"));
  EXPECT_TRUE(std::filesystem::exists(folder / "new/listed.json"));
  EXPECT_FALSE(std::filesystem::exists(folder / "new/command.log")) << "only what it was asked for is left";
}

TEST(OwnCommand, ThatFailsIsToldWithTheLastThatItSaid) {
  constexpr const char* is_command = "FLINCH_TEST_IS_COMMAND";
  if (std::getenv(is_command) != nullptr) {  // this test as the command of itself
    std::cerr << "a first line\nwhy it failed\n\n";
    FAIL();
  }
  const test::TemporaryFolder folder;
  ::setenv(is_command, "1", 1);
  const auto problems =
      test::problems_of([&] { run_own_command({"--gtest_filter=OwnCommand.ThatFails*"}, folder.path()); });
  ::unsetenv(is_command);
  EXPECT_THAT(problems, ElementsAre(HasSubstr("OwnCommand.ThatFails*' failed: why it failed")));
}

}  // namespace
}  // namespace flinch
