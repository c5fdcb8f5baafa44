#pragma once

#include <string>

namespace flinch {

/// What a running program says of itself.
struct RunStatus {
  std::string state;       ///< changes seldom
  std::string figures;     ///< change all the time
  std::string typed = {};  ///< by an operator who has not finished the line
  std::string said = {};   ///< to an operator, once; whole lines
  std::string noted = {};  ///< of the run, once; whole lines
};

}  // namespace flinch
