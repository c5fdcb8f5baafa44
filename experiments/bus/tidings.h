#pragma once

#include <string>

namespace flinch {

/// What a running program says of itself.
struct Tidings {
  std::string state;    ///< changes seldom
  std::string figures;  ///< change all the time
};

}  // namespace flinch
