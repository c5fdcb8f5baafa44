#pragma once

#include <array>

#include "learning/data_set.h"

namespace flinch {

/// When a classifier is judged, by the names of theory.md.
struct NamedMoment {
  const char* name;
  int which;  ///< of Moment
};
constexpr std::array named_moments{NamedMoment{"early", Moment::early},
                                   NamedMoment{"detected", Moment::detected},
                                   NamedMoment{"later", Moment::later}};

}  // namespace flinch
