#include "systems/framework/recording_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>

#include "systems/foundation/setup_error.h"
#include "tests/support/file_bytes.h"
#include "tests/systems/framework/honest_recording.h"

namespace flinch {
namespace {

using test::bytes_of;
using test::TemporaryFile;

/// Values of three blocks, the last of them not full.
Recording three_blocks() {
  Recording recording = test::honest_recording();
  const std::size_t count = 2 * Recording::block + 5;
  recording.time_ns.resize(count);
  for (std::size_t k = 0; k < count; ++k) recording.time_ns[k] = static_cast<std::int64_t>(k) * 1'000'000;
  for (Signal& signal : recording.signals) {
    signal.rows.resize(count * signal.layout.numbers);
    for (std::size_t i = 0; i < signal.rows.size(); ++i)
      signal.rows[i] = signal.rows[i % (test::honest_samples * signal.layout.numbers)];
  }
  return recording;
}

TEST(WriteRecording, WritesOneThatWasOnlyOpenedAsItStandsInItsFile) {
  const TemporaryFile file, copy;
  const Recording whole = three_blocks();
  write_recording(whole, file.path());
  write_recording(open_recording(file.path()), copy.path());
  const Recording again = read_recording(copy.path());
  ASSERT_EQ(again.time_ns, whole.time_ns);
  ASSERT_EQ(again.signals.size(), whole.signals.size());
  for (std::size_t i = 0; i < whole.signals.size(); ++i) {
    const auto& expected = whole.signals[i].rows;
    const auto& got = again.signals[i].rows;
    ASSERT_EQ(got.size(), expected.size());
    EXPECT_EQ(std::memcmp(got.data(), expected.data(), got.size() * sizeof(got[0])), 0);
  }
}

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
