// Logs of other tools as they are opened, told by their content: texts, HDF5, MATLAB, NumPy, bags.
#include "import/log_file.h"

#include <algorithm>
#include <numeric>

#include "systems/framework/recording.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/file_bytes.h"
#include "tests/support/matlab_bytes.h"
#include "tests/support/mcap_bytes.h"
#include "tests/support/numpy_bytes.h"
#include "tests/systems/framework/honest_recording.h"

namespace flinch::test {
namespace {

constexpr std::size_t most_columns = 16;

void try_log(std::string_view bytes) {
  const std::unique_ptr<LogFile> log = open_log(fuzz_file("some.log", bytes));
  std::vector<std::size_t> wanted(std::min(log->columns().size(), most_columns));
  std::iota(wanted.begin(), wanted.end(), std::size_t{0});
  log->read(wanted);
  if (!wanted.empty()) log->read_instants(0, ClockUnit::s);
}

std::vector<std::string> log_seeds() {
  const std::filesystem::path recording = fuzz_folder() / "seed.h5";
  write_recording(honest_recording(), recording);
  return {
      bytes_of(recording),
      "t,q,i\n0,1,2\n0.001,1.1,nan\n0.002,,2e-1\n",
      "# made by a tool\nRig: 7; 2024\nZeit;Winkel 1;Strom\n[s];[Grad];[mA]\n0,000;1,5;-3\n0,001;1,6;4\n",
      "time\t\"a \"\"b\"\"\"\tx\n2024-03-01T12:00:00.5Z\t1\t2\n2024-03-01T12:00:00.6Z\t3\t4\n",
      "1 2 3\n2 3 4\n1 2 3\n",
      mcap_file(mcap_schema(1, "geometry_msgs/msg/WrenchStamped") + mcap_channel(0, 1, "/wrench") +
                mcap_chunk(
                    mcap_message(
                        0, 5, CdrMessage(1, 2).add(1.0).add(2.0).add(3.0).add(0.1).add(0.2).add(0.3).bytes()),
                    "zstd")),
      mat_file({mat_matrix<double>(mat_double, "t", 2, 1, {0.0, 0.1}),
                mat_structs("run", {"q"}, {mat_matrix<double>(mat_double, "", 1, 2, {1.0, 2.0})})})};
}

}  // namespace

const FuzzTarget log_target{"log", try_log, log_seeds};

}  // namespace flinch::test
