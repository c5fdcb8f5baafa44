#pragma once

#include <string>
#include <utility>
#include <vector>

#include "systems/foundation/setup_error.h"

namespace flinch::test {

/// What `set_up()` throws as a SetupError; nothing if it does not.
template <class SetUp>
std::vector<std::string> problems_of(SetUp&& set_up) {
  try {
    std::forward<SetUp>(set_up)();
  } catch (const SetupError& error) {
    return error.problems();
  }
  return {};
}

}  // namespace flinch::test
