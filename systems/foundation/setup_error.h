#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace flinch {

/// The one exception type of flinch. It is thrown before a loop starts, never inside one, and carries every
/// problem that was found, each as one sentence that says where, what was found and what would be right.
class SetupError : public std::runtime_error {
 public:
  explicit SetupError(std::vector<std::string> problems);
  explicit SetupError(std::string problem) : SetupError(std::vector<std::string>{std::move(problem)}) {}

  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::vector<std::string> problems_;
};

/// Throws a SetupError with all `problems`; does nothing when there are none.
void throw_if_any(std::vector<std::string> problems);

}  // namespace flinch
