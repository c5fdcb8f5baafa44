#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace flinch {

/// Hands the latest value from one thread to another. Neither ever waits, locks or allocates, whatever the
/// other does: the writer owns one of three slots, the reader owns another, and the third lies between them.
///
/// One thread calls publish(), one other calls take(). A value that is followed by another before it was
/// taken is lost. What the writer did before publish() is visible to the reader after the take() that returns
/// the value. Copies of T must not touch the heap.
template <class T>
class TripleBuffer {
  static_assert(std::is_default_constructible_v<T> && std::is_copy_assignable_v<T>);

 public:
  /// Makes `value` the latest. Writer only.
  void publish(const T& value) noexcept {
    slots_[back_].value = value;
    back_ = between_.exchange(static_cast<std::uint8_t>(back_ | fresh), std::memory_order_acq_rel) & index;
  }

  /// Copies the latest value if there is one that was not taken yet; returns whether there was, and leaves
  /// `value` alone if not. Reader only.
  bool take(T& value) noexcept {
    if ((between_.load(std::memory_order_relaxed) & fresh) == 0) return false;
    front_ = between_.exchange(front_, std::memory_order_acq_rel) & index;
    value = slots_[front_].value;
    return true;
  }

 private:
  static constexpr std::uint8_t index = 3;
  static constexpr std::uint8_t fresh = 4;
  static constexpr std::size_t cache_line = 64;
  static_assert(std::atomic<std::uint8_t>::is_always_lock_free);

  struct alignas(cache_line) Slot {
    T value{};
  };

  std::array<Slot, 3> slots_;
  alignas(cache_line) std::uint8_t back_ = 0;                  ///< the writer's slot
  alignas(cache_line) std::atomic<std::uint8_t> between_ = 1;  ///< a slot, and whether it is fresh
  alignas(cache_line) std::uint8_t front_ = 2;                 ///< the reader's slot
};

}  // namespace flinch
