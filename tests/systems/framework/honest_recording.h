#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "systems/framework/recording.h"
#include "systems/framework/recording_check.h"
#include "tests/support/temporary_folder.h"

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

/// The name of a file that is gone with this.
class TemporaryFile {
 public:
  std::filesystem::path path() const { return folder_ / "honest.h5"; }

 private:
  TemporaryFolder folder_;
};

}  // namespace flinch::test
