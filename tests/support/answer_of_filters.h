#pragma once

#include <cmath>

namespace flinch::test {

/// Of three equal first-order filters in a row to a step of 1, `times` time constants after it.
inline double answer_of_three_filters(double times) {
  return times <= 0.0 ? 0.0 : 1.0 - std::exp(-times) * (1.0 + times + 0.5 * times * times);
}

}  // namespace flinch::test
