#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/comparison/comparison.h"
#include "systems/framework/recording.h"

namespace flinch {

/// One of the recordings that are compared.
struct ComparedRecording {
  std::string name;  ///< by which a reader knows it
  const Recording* recording = nullptr;
  double delay = 0.0;  ///< by which it is drawn earlier, so that it fits the first one [s]
  /// What its verdict says, by name; empty: it has none.
  std::vector<std::pair<std::string, std::string>> verdict;
  bool good = false;  ///< the verdict
};

/// What a page says besides of its recordings.
struct ComparisonFacts {
  std::string aligned_by;        ///< "time", "contact", "correlation"
  std::string first_difference;  ///< in a sentence
  std::vector<SettingDifference> settings;
  std::string call;                  ///< the command that compared them
  std::vector<std::string> notes{};  ///< what a reader should know before, a sentence each
};

/// One HTML page that needs nothing else: each signal that a reader looks at, of all recordings in one chart,
/// all charts with one time cursor; verdicts side by side; the settings that differ. A chart shows at
/// most 4000 samples; where there are more, the lowest and the highest of each stretch. Of a single recording
/// it has the notes and the signals.
std::string comparison_page(const std::vector<ComparedRecording>& compared, const ComparisonFacts& facts);

}  // namespace flinch
