#pragma once

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "systems/foundation/setup_error.h"

/// Readers of bytes that anybody may have written. Each is a target of its own: a function that libFuzzer
/// calls with all the bytes it can think of (`./dev fuzz`), and a test with those of the corpus.
namespace flinch::test {

struct FuzzTarget {
  const char* name;
  /// Reads the bytes as flinch reads a file or sample of them. SetupError is an answer; whatever else is
  /// thrown, a report of a sanitizer, a hang, or memory beyond what the bytes deserve is a fault.
  void (*read)(std::string_view bytes);
  /// What is read without a complaint, to begin with.
  std::vector<std::string> (*seeds)();
};

/// How tests name it.
inline void PrintTo(const FuzzTarget* target, std::ostream* stream) { *stream << target->name; }

extern const FuzzTarget campaign_target;
extern const FuzzTarget campaign_journal_target;
extern const FuzzTarget csv_target;
extern const FuzzTarget log_target;
extern const FuzzTarget data_journal_target;
extern const FuzzTarget data_set_target;
extern const FuzzTarget model_target;
extern const FuzzTarget onnx_target;
extern const FuzzTarget parameters_target;
extern const FuzzTarget recording_target;
extern const FuzzTarget recording_journal_target;
extern const FuzzTarget robot_target;
extern const FuzzTarget samples_target;
extern const FuzzTarget scenario_target;
extern const FuzzTarget words_target;

/// Whether the bytes are read without a complaint.
inline bool is_read(const FuzzTarget& target, std::string_view bytes) {
  try {
    target.read(bytes);
    return true;
  } catch (const SetupError&) {
    return false;
  }
}

}  // namespace flinch::test
