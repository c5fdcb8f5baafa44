// A long run needs no more memory than a short one, nor has it a larger page. One minute; FLINCH_LONG_RUN in
// the environment says how many seconds instead: with 3600 it takes five minutes.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/support/flinch_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

/// What the files of a folder take on the disk now, with what is set aside for them [MB].
double disk_of(const std::filesystem::path& folder) {
  double bytes = 0.0;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    struct stat status {};
    if (::stat(entry->path().c_str(), &status) == 0) bytes += 512.0 * static_cast<double>(status.st_blocks);
  }
  return 1e-6 * bytes;
}

struct Cost {
  double memory = 0.0;  ///< the most that was resident of any run so far [MB]
  double page = 0.0;    ///< [MB]
  double disk = 0.0;    ///< the most that was taken while the run went on [MB]
  double result = 0.0;  ///< the recording [MB]
};

class LongRun : public testing::Test {
 protected:
  /// Of a contact-free square of so many seconds, recorded, judged and shown.
  Cost run(int seconds) {
    const std::string scenario = FLINCH_SOURCE_DIR "/apps/scenarios/square_realistic.yaml",
                      out = folder_.path() / std::to_string(seconds);
    test::OtherProgram program(test::flinch_program(
        {"run", scenario, "--set", "duration_s=" + std::to_string(seconds), "--out", out, "--quiet"}));
    double disk = 0.0;
    for (; program.is_running(); std::this_thread::sleep_for(5ms)) disk = std::max(disk, disk_of(out));
    EXPECT_EQ(program.wait(1h), 0) << program.output();
    rusage most{};
    getrusage(RUSAGE_CHILDREN, &most);
    const double page = static_cast<double>(std::filesystem::file_size(out + "/report.html"));
    const double result = static_cast<double>(std::filesystem::file_size(out + "/run.h5"));
    const Cost cost{1e-3 * static_cast<double>(most.ru_maxrss), 1e-6 * page, disk, 1e-6 * result};
    std::printf(
        "  %5d s: at most %.0f MB resident, page of %.1f MB; on the disk at most %.0f MB, in the end %.0f\n",
        seconds, cost.memory, cost.page, cost.disk, cost.result);
    return cost;
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(LongRun, NeedsTheMemoryOfAShortOneAndHasAPageLikeIts) {
  const int seconds = test::wanted("FLINCH_LONG_RUN", 60);
  const Cost of_short = run(10), of_long = run(seconds);
  EXPECT_LT(of_long.memory, 300.0);
  EXPECT_LT(of_long.memory, of_short.memory + 50.0 + 0.03 * seconds) << "16 bytes a tick are kept of times";
  EXPECT_LT(of_long.disk, 2.0 * of_long.result + 60.0) << "what is set aside is that of 4096 samples";
  EXPECT_LT(of_long.page, 6.0);
  EXPECT_LT(of_short.memory, 300.0);
}

}  // namespace
}  // namespace flinch
