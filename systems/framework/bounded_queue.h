#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <type_traits>

namespace flinch {

/// Hands values from one thread to another, each of them and in order. Neither ever waits, locks or
/// allocates, whatever the other does; a full queue takes no more.
///
/// One thread calls push(), one other calls pop(). What the writer did before push() is visible to the reader
/// after the pop() that returns the value. Copies of T must not touch the heap.
template <class T, std::size_t Capacity>
class BoundedQueue {
  static_assert(Capacity > 0 && (Capacity & (Capacity - 1)) == 0,
                "a power of 2, so that the counts may wrap around");
  static_assert(std::is_default_constructible_v<T> && std::is_copy_assignable_v<T>);

 public:
  /// Appends `value`; returns false, and drops it, where Capacity values wait. Writer only.
  bool push(const T& value) noexcept {
    const std::size_t pushed = pushed_.load(std::memory_order_relaxed);
    if (pushed - popped_.load(std::memory_order_acquire) == Capacity) return false;
    values_[pushed % Capacity] = value;
    pushed_.store(pushed + 1, std::memory_order_release);
    return true;
  }

  /// Removes the oldest value and copies it; returns whether there was one, and leaves `value` alone if not.
  /// Reader only.
  bool pop(T& value) noexcept {
    const std::size_t popped = popped_.load(std::memory_order_relaxed);
    if (popped == pushed_.load(std::memory_order_acquire)) return false;
    value = values_[popped % Capacity];
    popped_.store(popped + 1, std::memory_order_release);
    return true;
  }

 private:
  static constexpr std::size_t cache_line = 64;
  static_assert(std::atomic<std::size_t>::is_always_lock_free);

  std::array<T, Capacity> values_{};
  alignas(cache_line) std::atomic<std::size_t> pushed_ = 0;  ///< since the start
  alignas(cache_line) std::atomic<std::size_t> popped_ = 0;
};

}  // namespace flinch
