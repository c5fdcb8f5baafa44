#pragma once

#include <cstddef>
#include <cstdint>

namespace flinch {

/// Where a value lies in the memory of a Context: at an offset [bytes] from its start or, for a value that
/// changes its place from tick to tick, at the offset that stands in a word of that memory.
class Place {
 public:
  constexpr Place() = default;
  /// At `offset`, always.
  static constexpr Place fixed(std::uint32_t offset) { return Place(offset); }
  /// At the offset that stands in the word at `word`.
  static constexpr Place moving(std::uint32_t word) { return Place(word | moving_bit); }

  std::byte* in(std::byte* memory) const { return memory + offset(memory); }
  const std::byte* in(const std::byte* memory) const { return memory + offset(memory); }

  friend constexpr bool operator==(Place, Place) = default;

  /// Places lie below this offset.
  static constexpr std::uint32_t limit = std::uint32_t{1} << 31U;

 private:
  static constexpr std::uint32_t moving_bit = limit;
  explicit constexpr Place(std::uint32_t bits) : bits_(bits) {}

  std::uint32_t offset(const std::byte* memory) const {
    if ((bits_ & moving_bit) == 0) return bits_;
    return *reinterpret_cast<const std::uint32_t*>(memory + (bits_ & ~moving_bit));
  }

  std::uint32_t bits_ = 0;
};

/// Two cells that take turns, so that a value becomes the state without being copied: in one lies what a
/// state is now, in the other what it will be. Two words say which is which.
struct DoubleBuffer {
  std::uint32_t now;    ///< the word that says where the state lies
  std::uint32_t next;   ///< the word that says where its next value lies, or is to be written
  std::uint32_t cells;  ///< the sum of the offsets of the two cells

  /// The next value is going to be written: it shall not lie where the state lies.
  void begin(std::byte* memory) const { word(memory, next) = cells - word(memory, now); }
  /// The next value has become the state.
  void end(std::byte* memory) const { word(memory, now) = word(memory, next); }
  /// The next value is not computed: it is what the state is.
  void stay(std::byte* memory) const { word(memory, next) = word(memory, now); }
  /// The state is going to be written by itself: it shall not lie where the next value lies.
  void part(std::byte* memory) const {
    if (word(memory, now) == word(memory, next)) word(memory, now) = cells - word(memory, next);
  }

 private:
  static std::uint32_t& word(std::byte* memory, std::uint32_t offset) {
    return *reinterpret_cast<std::uint32_t*>(memory + offset);
  }
};

}  // namespace flinch
