#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/workplace.h"

namespace flinch::test {

/// The keys of what a verb prints, and of the objects in its lists, that a chapter of docs/files.md, "JSON",
/// does not name.
inline std::vector<std::string> undocumented_keys(const nlohmann::json& printed, const std::string& chapter) {
  static const std::string document = bytes_of(FLINCH_SOURCE_DIR "/docs/files.md");
  const std::size_t begin = document.find("\n## " + chapter + "\n");
  if (begin == std::string::npos) throw std::invalid_argument(chapter + ": there is no such chapter");
  const std::string text = document.substr(begin, document.find("\n## ", begin + 1) - begin);
  std::vector<std::string> missing;
  for (const auto& [key, value] : printed.items()) {
    if (text.find("`" + key + "`") == std::string::npos) missing.push_back(key);
    if (!value.is_array()) continue;
    for (const nlohmann::json& entry : value) {
      if (!entry.is_object()) continue;
      for (const std::string& below : undocumented_keys(entry, chapter)) missing.push_back(key + "." + below);
    }
  }
  return missing;
}

}  // namespace flinch::test
