#pragma once

#include <string>
#include <utility>
#include <vector>

#include "systems/foundation/setup_error.h"

namespace flinch {

/// Keys are wrong whatever their values: unknown, without effect, or with the unit of another quantity.
class KeyError : public SetupError {
 public:
  /// `of_keys`: those of `problems` that no value would mend.
  KeyError(std::vector<std::string> problems, std::vector<std::string> of_keys)
      : SetupError(std::move(problems)), of_keys_(std::move(of_keys)) {}

  const std::vector<std::string>& of_keys() const { return of_keys_; }

 private:
  std::vector<std::string> of_keys_;
};

}  // namespace flinch
