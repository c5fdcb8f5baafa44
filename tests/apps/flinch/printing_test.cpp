#include "apps/flinch/printing.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>

#include "systems/foundation/setup_error.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::internal::CaptureStderr;
using ::testing::internal::CaptureStdout;
using ::testing::internal::GetCapturedStderr;
using ::testing::internal::GetCapturedStdout;

/// A stream whose disk is full, for as long as this lives.
class FullDisk {
 public:
  explicit FullDisk(FILE* stream) : stream_(stream), before_(::dup(::fileno(stream))) {
    std::fflush(stream_);
    const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
    ::dup2(full, ::fileno(stream_));
    ::close(full);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() {
    std::clearerr(stream_);
    ::dup2(before_, ::fileno(stream_));
    ::close(before_);
  }

 private:
  FILE* stream_;
  int before_;
};

TEST(Printing, TellsResultsAndMessagesApart) {
  CaptureStdout();
  CaptureStderr();
  print_result("{} of {}\n", 1, "two");
  print_message("as {}\n", "said");
  EXPECT_EQ(GetCapturedStdout(), "1 of two\n");
  EXPECT_EQ(GetCapturedStderr(), "as said\n");
  EXPECT_NO_THROW(require_printed());
}

TEST(Printing, LosesMessagesWithoutAWord) {
  const FullDisk full(stderr);
  EXPECT_NO_THROW(print_message("{}\n", std::string(100'000, 'x')));
  EXPECT_NO_THROW(clear_line());
  EXPECT_NO_THROW(flush_messages());
  EXPECT_NO_THROW(require_printed());
}

TEST(Printing, SaysOnceThatResultsWereLost) {
  for (const std::size_t letters : {1U, 100'000U}) {  // that stay in a buffer, and that do not
    const FullDisk full(stdout);
    EXPECT_NO_THROW(print_results(std::string(letters, 'x')));
    EXPECT_NO_THROW(flush_results());
    EXPECT_THAT(test::problems_of([] { require_printed(); }),
                ElementsAre("what was to be printed cannot be written: No space left on device"));
    EXPECT_NO_THROW(require_printed());
  }
}

TEST(Printing, ShowsWhatATerminalWouldObey) {
  CaptureStdout();
  CaptureStderr();
  print_result("{}\n", "a\x1b[31m");
  print_message("{}\n", "a\x07\xc2\x9b\xff");
  EXPECT_EQ(GetCapturedStdout(), "a\\u001b[31m\n");
  EXPECT_EQ(GetCapturedStderr(), "a\\u0007\\u009b\\xff\n");
}

// Whatever names a file has, and whatever file it is, nothing of it reaches the terminal as it is.
TEST(Printing, ShowsNamesOfEveryKindOfInput) {
  const test::Workplace place;
  const std::string bad = "q\x1b]0;t\x07\xc2\x9b";
  place.write("key.yaml", "robot: robots/planar_3rrr.yaml\n\"" + bad + "\": 1\n");
  place.write("file.yaml", "robot: \"" + bad + ".yaml\"\n");
  place.write("value.yaml", "robot: robots/planar_3rrr.yaml\nmotion: {kind: \"" + bad + "\"}\n");
  place.write("log.csv", "time_s," + bad + "\n0,1\n");
  place.write("mapping.yaml", "flinch_mapping: 1\nlog: log.csv\n\"" + bad + "\": 1\n");
  place.write("recording.h5", "no " + bad);
  place.write("classifier.onnx", bad);
  place.write(bad + ".yaml", "robot: none.yaml\n");
  const std::vector<std::string> names = {"key.yaml", "file.yaml",    "value.yaml",      "mapping.yaml",
                                          "log.csv",  "recording.h5", "classifier.onnx", bad + ".yaml"};
  for (const std::string& name : names) {
    for (const std::string verb : {"check", "run"}) {
      const test::Outcome outcome = test::flinch({verb, place.at(name)});
      EXPECT_EQ(outcome.status, 2) << name;
      for (const char* const raw : {"\x1b", "\x07", "\xc2\x9b"}) {
        EXPECT_EQ(outcome.err.find(raw), std::string::npos) << outcome.err;
        EXPECT_EQ(outcome.out.find(raw), std::string::npos) << outcome.out;
      }
    }
  }
  EXPECT_THAT(test::flinch({"check", place.at("key.yaml")}).err, HasSubstr("q\\u001b]0;t\\u0007\\u009b"));
}

TEST(Printing, IndentsWhatFollowsALineFeedOfAName) {
  const test::Workplace place;
  place.write("key.yaml", "robot: robots/planar_3rrr.yaml\n\"a\\nerror: all is well\": 1\n");
  const std::string said = test::flinch({"check", place.at("key.yaml")}).err;
  EXPECT_THAT(said, HasSubstr("a\n       error: all is well"));
}

}  // namespace
}  // namespace flinch
