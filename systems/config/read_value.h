#pragma once

#include <string>

namespace flinch {

/// A value as it took effect, for the list of all parameters of a run.
struct ReadValue {
  std::string key;         ///< Path without unit: "legs[1].link1_length".
  std::string value;       ///< In SI, so that reading it gives the same bits: "0.58121", "[20, 20, 10]".
  std::string unit;        ///< Symbol of the SI unit, "kg m^2"; empty for none.
  bool from_file = false;  ///< Otherwise the file is silent and this is the default.
};

}  // namespace flinch
