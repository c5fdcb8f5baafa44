#include "calibration/calibration_sources.h"

#include <map>
#include <string>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/foundation/sha256.h"
#include "systems/framework/recording_journal.h"

namespace flinch {

CalibrationSource source_of(const std::filesystem::path& file) {
  return {file.string(), sha256_of(std::filesystem::exists(file) ? file : part_name(file))};
}

void require_different(const std::vector<CalibrationSource>& recordings) {
  std::map<std::string, std::string> files;
  std::vector<std::string> problems;
  for (const CalibrationSource& recording : recordings) {
    const auto [first, is_new] = files.emplace(recording.sha256, recording.file);
    if (!is_new)
      problems.push_back(recording.file + ": holds the same as " + first->second + "; leave one of them out");
  }
  throw_if_any(std::move(problems));
}

}  // namespace flinch
