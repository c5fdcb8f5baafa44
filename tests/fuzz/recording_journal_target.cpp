// Journals of runs. Lengths and checksums of their frames are made good before they are read: who writes a
// hostile journal does so too, and what lies behind them is what is to be tried.
#include "systems/framework/recording_journal.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/read_recording.h"
#include "tests/support/file_bytes.h"
#include "tests/systems/framework/honest_recording.h"

namespace flinch::test {
namespace {

/// Mark, length and checksum, before the payload; all of 8 bytes.
constexpr std::size_t head = 24;

std::uint64_t word_at(const std::string& bytes, std::size_t at) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes.data() + at, 8);
  return word;
}

/// FNV-1a over words, as the journal has it.
std::uint64_t checksum(const std::string& bytes, std::size_t begin, std::size_t length) {
  std::uint64_t value = 0xcbf29ce484222325;
  for (std::size_t at = begin; at < begin + length; at += 8) {
    value = (value ^ word_at(bytes, at)) * 0x100000001b3;
    value ^= value >> 32;
  }
  return value;
}

/// The same frames, as if somebody had meant them so.
std::string with_good_frames(std::string_view hostile) {
  std::string bytes(hostile.substr(0, hostile.size() / 8 * 8));
  for (std::size_t at = 0; at + head <= bytes.size();) {
    const std::uint64_t length =
        std::min<std::uint64_t>(word_at(bytes, at + 8), bytes.size() - at - head) / 8 * 8;
    const std::uint64_t sum = checksum(bytes, at + head, length);
    std::memcpy(bytes.data() + at + 8, &length, 8);
    std::memcpy(bytes.data() + at + 16, &sum, 8);
    at += head + length;
  }
  return bytes;
}

void try_recording_journal(std::string_view bytes) {
  const std::filesystem::path file = fuzz_file("fuzzed.h5.part", with_good_frames(bytes));
  is_journal(file);
  read_all_of(open_journal(file));
}

std::vector<std::string> recording_journal_seeds() {
  const Recording recording = honest_recording();
  const std::filesystem::path file = fuzz_folder() / "seed.h5.part";
  {
    RecordingJournal journal(recording, file);
    const std::size_t numbers = recording.signals[0].layout.numbers;
    const SampleBlock all{recording.time_ns, {{recording.signals[0].rows.data(), numbers, numbers}}};
    for (std::size_t first = 0; first < honest_samples; first += 10) journal.append(all.part(first, 10));
  }
  return {bytes_of(file)};
}

}  // namespace

const FuzzTarget recording_journal_target{"recording_journal", try_recording_journal,
                                          recording_journal_seeds};

}  // namespace flinch::test
