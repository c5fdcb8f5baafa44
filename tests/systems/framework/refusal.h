#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch::test {

/// Reads all that there is, in each way that there is. What is wrong with it; empty if it could be read.
inline std::string refusal(const std::filesystem::path& file) {
  try {
    const Recording recording = open_recording(file);
    for (const Signal& signal : recording.signals) {
      std::vector<internal::Number> rows(recording.samples() * signal.layout.numbers);
      recording.read_rows(signal, 0, recording.samples(), rows.data());
      for (const Field& field : signal.layout.fields) {
        for (const int element : {0, field.capacity - 1, field.capacity, -1}) {
          recording.column(signal.path, field.name, element);
        }
      }
    }
    return "";
  } catch (const SetupError& error) {
    return error.what();
  }
}

}  // namespace flinch::test
