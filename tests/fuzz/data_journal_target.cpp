// Journals of data sets. Lengths and checksums of their frames are made good before they are read.
#include "experiments/dataset/data_journal.h"

#include <cstdint>
#include <cstring>

#include "experiments/dataset/data_spec.h"
#include "systems/config/robot_file.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/file_bytes.h"

namespace flinch::test {
namespace {

const ParallelRobot& robot() {
  static const auto loaded = load_robot(FLINCH_SOURCE_DIR "/apps/robots/planar_3rrr.yaml");
  return *loaded;
}

std::string journal_of(const ContactSamples* samples) {
  const std::filesystem::path file = fuzz_folder() / "seed.part";
  std::filesystem::remove(file);
  {
    DataJournal journal(file, DataSpec{}, robot());
    if (samples != nullptr) journal.add(1, *samples);
  }
  return bytes_of(file);
}

/// What stands before a frame: its length, and FNV-1a of its bytes.
std::string sealed(std::string_view frame) {
  std::uint64_t head[2] = {frame.size(), 0xcbf29ce484222325U};
  for (const char c : frame) head[1] = (head[1] ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  std::string bytes(sizeof head, '\0');
  std::memcpy(bytes.data(), head, sizeof head);
  return bytes.append(frame);
}

/// One frame that is good, then one that promises as many bytes as there could be.
void try_data_journal(std::string_view bytes) {
  static const std::string header = journal_of(nullptr);
  std::string journal = header + sealed(bytes);
  journal.append("\xff\xff\xff\x3f\0\0\0\0", 8).append("12345678 and too little");
  const DataJournal read(fuzz_file("fuzzed.part", journal), DataSpec{}, robot());
}

std::vector<std::string> data_journal_seeds() {
  ContactSamples samples;
  for (int i = 0; i < 3; ++i) {
    DataSample& sample = samples.samples.emplace_back();
    sample.touched = i;
    sample.pose = robot().home_pose();
    sample.course.fill({PlatformVector::Ones(robot().dof()), PlatformVector::Zero(robot().dof())});
  }
  return {journal_of(&samples).substr(journal_of(nullptr).size() + 16)};
}

}  // namespace

const FuzzTarget data_journal_target{"data_journal", try_data_journal, data_journal_seeds};

}  // namespace flinch::test
