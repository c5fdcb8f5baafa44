// One target of tests/fuzz as libFuzzer wants it. FLINCH_FUZZ_SEEDS in the environment names a folder into
// which the target's seeds are written before it begins.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* const folder = std::getenv("FLINCH_FUZZ_SEEDS");
  if (folder == nullptr) return 0;
  std::filesystem::create_directories(folder);
  int number = 0;
  for (const std::string& seed : flinch::test::FLINCH_FUZZ_TARGET.seeds())
    std::ofstream(std::string(folder) + "/seed" + std::to_string(number++), std::ios::binary) << seed;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  flinch::test::is_read(flinch::test::FLINCH_FUZZ_TARGET, {reinterpret_cast<const char*>(data), size});
  return 0;
}
