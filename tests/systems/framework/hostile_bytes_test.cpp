// Recordings and journals of any bytes: each is refused with a reason, or read; none does harm.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>

#include "systems/framework/recording.h"
#include "systems/framework/recording_journal.h"
#include "tests/support/file_bytes.h"
#include "tests/systems/framework/honest_recording.h"
#include "tests/systems/framework/refusal.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::refusal;
using test::TemporaryFile;

constexpr std::size_t samples = test::honest_samples;

void write_bytes(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Reads the file again and again with some bytes changed or its end missing.
void expect_no_harm_by_any_bytes(const fs::path& file, unsigned seed) {
  const std::string whole = bytes_of(file);
  std::mt19937 random(seed);
  int refused = 0;
  constexpr int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    std::string bytes = whole;
    for (int change = 0; change < 1 + trial % 4; ++change) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    if (trial % 5 == 0) bytes.resize(random() % bytes.size());
    write_bytes(file, bytes);
    refused += refusal(file).empty() ? 0 : 1;
  }
  std::cout << trials << " files, " << refused << " refused" << std::endl;
  EXPECT_GT(refused, 100);
}

TEST(HostileJournal, MayHaveAnyBytesAndIsReadAsFarAsItIsWhole) {
  const TemporaryFile file;
  const Recording recording = test::honest_recording();
  {
    RecordingJournal journal(recording, file.path());
    const SampleBlock all{recording.time_ns, {{recording.signals[0].rows.data(), 13, 13}}};
    for (std::size_t first = 0; first < samples; first += 10) journal.append(all.part(first, 10));
  }
  ASSERT_EQ(refusal(file.path()), "");
  expect_no_harm_by_any_bytes(file.path(), 7);
}

TEST(HostileRecording, MayHaveAnyBytes) {
  const TemporaryFile file;
  write_recording(test::honest_recording(), file.path());
  expect_no_harm_by_any_bytes(file.path(), 11);
}

}  // namespace
}  // namespace flinch
