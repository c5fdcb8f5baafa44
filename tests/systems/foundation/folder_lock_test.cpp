#include "systems/foundation/folder_lock.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "systems/foundation/setup_error.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;

class FolderLocks : public testing::Test {
 protected:
  const test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

TEST_F(FolderLocks, NameWhoHasTheFolder) {
  const FolderLock lock(folder_);
  try {
    const FolderLock second(folder_);
    ADD_FAILURE();
  } catch (const SetupError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("the process " + std::to_string(::getpid()) + " ("));
  }
}

TEST_F(FolderLocks, LeaveNothingBehind) {
  { const FolderLock lock(folder_); }
  EXPECT_TRUE(fs::is_empty(folder_));
  EXPECT_NO_THROW(FolderLock{folder_});
}

TEST_F(FolderLocks, EndWithTheProgramThatIsKilled) {
  int ready[2] = {};
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const FolderLock lock(folder_);
    [[maybe_unused]] const ssize_t written = ::write(ready[1], "x", 1);
    ::pause();
    ::_exit(0);
  }
  char byte = 0;
  EXPECT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_THROW(FolderLock{folder_}, SetupError);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_NO_THROW(FolderLock{folder_});
  for (const int end : ready) ::close(end);
}

}  // namespace
}  // namespace flinch
