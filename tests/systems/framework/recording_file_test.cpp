#include "systems/framework/recording_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "systems/foundation/setup_error.h"
#include "tests/support/file_bytes.h"
#include "tests/systems/framework/honest_recording.h"

namespace flinch {
namespace {

using test::bytes_of;
using test::TemporaryFile;

TEST(FullDisk, KeepsTheOlderRecordingWhateverFits) {
  const TemporaryFile file;
  write_recording(test::honest_recording(), file.path());
  const std::string older = bytes_of(file.path());
  Recording larger = test::honest_recording();
  larger.attributes["scenario.text"] = std::string(20'000, 'x');
  int refused = 0, written = 0;
  for (rlim_t size = 0; size < 60'000; size += 600) {
    const pid_t child = ::fork();
    if (child == 0) {
      std::signal(SIGXFSZ, SIG_IGN);  // HDF5 then learns it from each call
      const rlimit limit{size, size};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      try {
        write_recording(larger, file.path());
      } catch (const SetupError&) {
        std::exit(2);  // whatever HDF5 does at the end of a program
      }
      std::exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status)) << size << ": ended by the signal " << WTERMSIG(status);
    const bool is_refused = WEXITSTATUS(status) != 0;
    (is_refused ? refused : written) += 1;
    EXPECT_EQ(bytes_of(file.path()) == older, is_refused) << size;
    if (!is_refused) write_recording(test::honest_recording(), file.path());
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(written, 10);
}

}  // namespace
}  // namespace flinch
