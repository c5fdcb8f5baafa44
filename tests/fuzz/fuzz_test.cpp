// The fuzz targets with what is at hand: their seeds, what fuzzing has found worth keeping, and some thousand
// changes of these. Hours of it, under sanitizers and led by what was reached: ./dev fuzz.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <set>
#include <string>

#include "systems/framework/random.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/file_bytes.h"
#include "tests/support/sanitized.h"

namespace flinch::test {
namespace {

std::vector<std::string> corpus_of(const FuzzTarget& target) {
  std::vector<std::string> all = target.seeds();
  const std::filesystem::path folder =
      std::filesystem::path(FLINCH_SOURCE_DIR) / "tests/fuzz/corpus" / target.name;
  if (!std::filesystem::exists(folder)) return all;
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.insert(entry.path());
  for (const std::filesystem::path& file : files) all.push_back(bytes_of(file));
  return all;
}

/// Bytes that change, parts that go, come twice, or come from another file.
std::string changed(std::string bytes, const std::vector<std::string>& others, RandomGenerator& random) {
  for (std::uint64_t left = 1 + random() % 4; left > 0 && !bytes.empty(); --left) {
    const std::size_t at = random() % bytes.size(),
                      length = std::min<std::size_t>(random() % 32, bytes.size() - at);
    const std::string& other = others[random() % others.size()];
    switch (random() % 6) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
        break;
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(at, bytes.substr(random() % bytes.size(), length));
        break;
      case 4:
        bytes.insert(at, other.substr(random() % std::max<std::size_t>(other.size(), 1), 32));
        break;
      default:
        bytes.resize(at);
        break;
    }
  }
  return bytes;
}

long peak_kB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

class Readers : public testing::TestWithParam<const FuzzTarget*> {};

INSTANTIATE_TEST_SUITE_P(Fuzz, Readers,
                         testing::Values(&campaign_target, &campaign_journal_target, &csv_target, &log_target,
                                         &data_journal_target, &data_set_target, &model_target, &onnx_target,
                                         &parameters_target, &recording_target, &recording_journal_target,
                                         &robot_target, &samples_target, &scenario_target, &words_target),
                         [](const auto& each) { return each.param->name; });

TEST_P(Readers, TakeTheSeeds) {
  for (const std::string& seed : GetParam()->seeds()) {
    try {
      GetParam()->read(seed);
    } catch (const SetupError& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

TEST_P(Readers, RefuseOrTakeAnyBytesWithLittleMemory) {
  const std::vector<std::string> corpus = corpus_of(*GetParam());
  RandomGenerator random(5);
  const long before = peak_kB();
  int taken = 0;
  std::size_t largest = 0;
  for (const std::string& bytes : corpus) taken += is_read(*GetParam(), bytes) ? 1 : 0;
  constexpr int changes = 400;
  for (int i = 0; i < changes; ++i) {
    const std::string bytes = changed(corpus[random() % corpus.size()], corpus, random);
    largest = std::max(largest, bytes.size());
    taken += is_read(*GetParam(), bytes) ? 1 : 0;
  }
  std::cout << corpus.size() << " files and " << changes << " changes of them, " << taken << " taken, "
            << peak_kB() - before << " kB more memory" << std::endl;
  if (sanitized()) return;  // it keeps what is freed
  EXPECT_LT(peak_kB() - before, 50'000 + 4 * static_cast<long>(largest) / 1000);
}

}  // namespace
}  // namespace flinch::test
