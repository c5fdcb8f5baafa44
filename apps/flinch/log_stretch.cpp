#include "apps/flinch/log_stretch.h"

#include <stdexcept>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// "1.5..3" [s].
LogTruth::Stretch stretch_of(const std::string& text) {
  const std::size_t dots = text.find("..");
  LogTruth::Stretch stretch;
  std::size_t read = 0;
  try {
    if (dots == std::string::npos) throw std::invalid_argument("");
    stretch.from = std::stod(text.substr(0, dots), &read);
    if (read != dots) throw std::invalid_argument("");
    stretch.to = std::stod(text.substr(dots + 2), &read);
    if (read != text.size() - dots - 2) throw std::invalid_argument("");
  } catch (const std::exception&) {
    throw SetupError("--free: is '" + text + "'; it must be two times in s, such as 0..1.3");
  }
  return stretch;
}

}  // namespace

std::vector<LogTruth::Stretch> stretches_of(const std::vector<std::string>& texts) {
  std::vector<LogTruth::Stretch> stretches;
  for (const std::string& text : texts) stretches.push_back(stretch_of(text));
  return stretches;
}

}  // namespace flinch
