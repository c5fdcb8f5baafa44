#pragma once

namespace flinch {

/// The root between `low`, where `f` is positive, and `high`, to the last bit.
template <class Function>
double bisect(Function f, double low, double high) {
  while (true) {
    const double middle = 0.5 * (low + high);
    if (!(middle > low && middle < high)) return middle;
    (f(middle) > 0.0 ? low : high) = middle;
  }
}

}  // namespace flinch
