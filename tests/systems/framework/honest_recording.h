#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "systems/framework/recording.h"
#include "systems/framework/recording_check.h"

/// A recording that holds what it says, for tests of what becomes of it in a file.
namespace flinch::test {

inline constexpr std::size_t honest_samples = 50;

/// A signal with a field of each kind.
inline Recording honest_recording() {
  Recording recording{Time(1'000'000), {}, {{"seed", "1"}}, {}, nullptr};
  Signal signal{"bench/state", {}, {}};
  const std::vector<Field> fields = {{"position", "m", "base", Field::Kind::real, 3, false},
                                     {"count", "", "", Field::Kind::integer, 1, false},
                                     {"valid", "", "", Field::Kind::boolean, 1, false},
                                     {"joints", "rad", "", Field::Kind::real, 6, true}};
  for (const Field& field : fields) internal::add_field(field, signal.layout);
  for (std::size_t k = 0; k < honest_samples; ++k) {
    recording.time_ns.push_back(static_cast<std::int64_t>(k) * 1'000'000);
    std::array<internal::Number, 13> row{};
    row[0].real = 0.1 * static_cast<double>(k);
    row[3].integer = static_cast<std::int64_t>(k);
    row[4].integer = 1;
    row[5].integer = 3;
    row[6].integer = 1;
    signal.rows.insert(signal.rows.end(), row.begin(), row.end());
  }
  recording.signals.push_back(std::move(signal));
  return recording;
}

/// A file that is there while this object is.
class TemporaryFile {
 public:
  TemporaryFile() {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() / (std::string("flinch_check_") + test->name() + ".h5");
    std::filesystem::remove(path_);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::filesystem::remove(path_); }

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace flinch::test
