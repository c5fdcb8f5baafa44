#pragma once

#include <type_traits>

namespace flinch::test {

/// Derivative of `f` at 0 by fourth-order central differences.
template <class F>
auto derivative(F f, double step = 1e-3) {
  using Value = std::decay_t<decltype(f(0.0))>;
  return Value((8.0 * (f(step) - f(-step)) - (f(2.0 * step) - f(-2.0 * step))) / (12.0 * step));
}

}  // namespace flinch::test
