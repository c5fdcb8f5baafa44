// Recordings in HDF5.
#include "systems/framework/recording.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/read_recording.h"
#include "tests/support/file_bytes.h"
#include "tests/systems/framework/honest_recording.h"

namespace flinch::test {
namespace {

void try_recording(std::string_view bytes) { read_all_of(open_recording(fuzz_file("fuzzed.h5", bytes))); }

std::vector<std::string> recording_seeds() {
  const std::filesystem::path file = fuzz_folder() / "seed.h5";
  write_recording(honest_recording(), file);
  return {bytes_of(file)};
}

}  // namespace

const FuzzTarget recording_target{"recording", try_recording, recording_seeds};

}  // namespace flinch::test
