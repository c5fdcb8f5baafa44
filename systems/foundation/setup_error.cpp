#include "systems/foundation/setup_error.h"

#include <utility>

namespace flinch {
namespace {

std::string one_a_line(const std::vector<std::string>& problems) {
  std::string text;
  for (const std::string& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem;
  }
  return text;
}

}  // namespace

SetupError::SetupError(std::vector<std::string> problems)
    : std::runtime_error(one_a_line(problems)), problems_(std::move(problems)) {}

void throw_if_any(std::vector<std::string> problems) {
  if (!problems.empty()) throw SetupError(std::move(problems));
}

}  // namespace flinch
