#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace flinch {

/// The last n values of a signal, in two parts. A watch remembers from tick to tick how many there have been,
/// and the newest; all of them lie in a past, which is long and is therefore never copied: the newest goes
/// there at the end of its tick. `Series` reads both.
template <class T, std::size_t n>
struct Ring {
  using Past = std::array<T, n>;

  T newest{};
  std::size_t count = 0;  ///< since it was empty

  /// At most once a tick.
  void push(const T& value) noexcept {
    newest = value;
    ++count;
  }
  void clear() noexcept { count = 0; }
  /// At the end of a tick.
  void keep_in(Past& past) const noexcept {
    if (count > 0) past[(count - 1) % n] = newest;
  }
};

/// A ring during a tick, with the past that it had before.
template <class T, std::size_t n>
class Series {
 public:
  Series(const Ring<T, n>& ring, const std::array<T, n>& past) : ring_(ring), past_(past) {}

  std::size_t held() const noexcept { return std::min(ring_.count, n); }
  /// Of age 0 the newest; `age` below held().
  const T& back(std::size_t age) const noexcept {
    return age == 0 ? ring_.newest : past_[(ring_.count - 1 - age) % n];
  }

 private:
  const Ring<T, n>& ring_;
  const std::array<T, n>& past_;
};

}  // namespace flinch
