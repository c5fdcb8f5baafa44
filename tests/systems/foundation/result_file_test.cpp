#include "systems/foundation/result_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <iterator>

#include "systems/foundation/setup_error.h"
#include "tests/support/file_bytes.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ResultFiles : public testing::Test {
 protected:
  fs::path file(const std::string& name = "a.txt") const { return folder_ / name; }
  auto files() const {
    return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator());
  }
  std::string text(const std::string& name = "a.txt") const { return test::bytes_of(file(name)); }

 private:
  test::TemporaryFolder folder_;
};

/// Does `work` in a program of its own, which ends without cleaning up. Its exit status.
template <class Work>
int in_another_program(const Work& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(ResultFiles, KeepTheOlderOneUntilTheNewOneIsWhole) {
  write_result(file(), "old");
  {
    const ResultFile unfinished(file());
    unfinished.write("half of the ne");
    EXPECT_EQ(text(), "old");
    EXPECT_EQ(files(), 2);
  }
  EXPECT_EQ(text(), "old");
  EXPECT_EQ(files(), 1);
  write_result(file(), "new");
  EXPECT_EQ(text(), "new");
  EXPECT_EQ(files(), 1);
}

TEST_F(ResultFiles, OfSeveralProgramsAtATimeEndAsOneOfThem) {
  ResultFile first(file()), second(file());
  first.write("first");
  second.write("second");
  EXPECT_NE(first.unfinished_name(), second.unfinished_name());
  second.finish();
  first.finish();
  EXPECT_EQ(text(), "first");
  EXPECT_EQ(files(), 1);
}

TEST_F(ResultFiles, OfDeadProgramsAreRemovedAndThoseOfLivingOnesAreNot) {
  const ResultFile living(file());
  in_another_program([this] {
    auto* const dead = new ResultFile(file());
    dead->write("half");
  });
  write_result(file("a.txt.notes.new"), "somebody's own");
  EXPECT_EQ(files(), 3);
  write_result(file(), "new");
  EXPECT_EQ(files(), 3) << "the result, the living one, and the other file";
  EXPECT_TRUE(fs::exists(living.unfinished_name()));
}

TEST_F(ResultFiles, ReplaceASymbolicLinkAndDoNotFollowIt) {
  write_result(file("precious.txt"), "precious");
  fs::create_symlink(file("precious.txt"), file());
  write_result(file(), "new");
  EXPECT_EQ(text("precious.txt"), "precious");
  EXPECT_FALSE(fs::is_symlink(file()));
  EXPECT_EQ(text(), "new");
}

TEST_F(ResultFiles, WriteADeviceOrPipeAsItIs) {
  ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0600), 0);
  const int reader = ::open(file("pipe").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  write_result(file("pipe"), "text");
  char bytes[8] = {};
  EXPECT_EQ(::read(reader, bytes, sizeof(bytes)), 4);
  EXPECT_STREQ(bytes, "text");
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(file("pipe")));
  EXPECT_NO_THROW(write_result("/dev/null", "text"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(ResultFiles, SayAtOnceWhatCannotBeWritten) {
  try {
    const ResultFile nowhere(file("no/folder.txt"));
    ADD_FAILURE();
  } catch (const SetupError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no/folder.txt: the file cannot be written: No such file"));
  }
  EXPECT_THROW(ResultFile(file("")), SetupError) << "a folder";
  EXPECT_THROW(ResultFile(file()).reserve(std::size_t{1} << 60), SetupError);
  EXPECT_EQ(files(), 0);
}

TEST_F(ResultFiles, HaveTheirPlaceTriedWithoutATrace) {
  require_place("", {file()});
  require_place(file(), {file("input.txt"), file("no/input.txt")});
  EXPECT_EQ(files(), 0);
  write_result(file("input.txt"), "old");
  fs::create_hard_link(file("input.txt"), file("link.txt"));
  for (const std::string name : {"input.txt", "link.txt", "no/folder.txt", ""})
    EXPECT_THROW(require_place(file(name), {file("other.txt"), file("input.txt")}), SetupError) << name;
  EXPECT_EQ(text("input.txt"), "old");
  EXPECT_EQ(files(), 2);
}

TEST_F(ResultFiles, ThatAreNotToStayAreRemovedAndNothingElse) {
  write_result(file(), "text");
  ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0600), 0);
  fs::create_symlink(file(), file("link"));
  for (const char* const name : {"pipe", "link", "none"}) remove_unfinished(file(name));
  EXPECT_EQ(files(), 3);
  remove_unfinished(file());
  EXPECT_EQ(files(), 2);
}

TEST_F(ResultFiles, KeepTheOlderOneAtWhateverSizeTheDiskIsFull) {
  write_result(file(), "old");
  const std::string text_of_ten(10'000, 'x');
  for (rlim_t most = 0; most <= 10'000; most += 500) {
    const int status = in_another_program([&] {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{most, most};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      try {
        write_result(file(), text_of_ten);
      } catch (const SetupError&) {
        ::_exit(2);
      }
    });
    EXPECT_EQ(status, most < 10'000 ? 2 : 0) << most;
    EXPECT_EQ(text(), most < 10'000 ? "old" : text_of_ten) << most;
    EXPECT_EQ(files(), 1) << most;
  }
}

}  // namespace
}  // namespace flinch
