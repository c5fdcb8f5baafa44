#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace flinch {

/// Some of the pairs of bodies, or of a body and an obstacle, that may touch: those that can do so within a
/// tick. What a number stands for, the robot's geometry says.
class ContactCandidates {
 public:
  static constexpr std::size_t capacity = 256;

  constexpr ContactCandidates() = default;
  static constexpr ContactCandidates all() {
    ContactCandidates every;
    every.pairs_.fill(~std::uint64_t{0});
    return every;
  }

  constexpr void add(std::size_t pair) { pairs_[pair / 64] |= std::uint64_t{1} << (pair % 64); }
  constexpr bool contains(std::size_t pair) const { return (pairs_[pair / 64] >> (pair % 64) & 1U) != 0; }
  constexpr bool none() const {
    std::uint64_t any = 0;
    for (const std::uint64_t word : pairs_) any |= word;
    return any == 0;
  }
  constexpr int count() const {
    int sum = 0;
    for (const std::uint64_t word : pairs_) sum += std::popcount(word);
    return sum;
  }

  /// Calls visit(pair) for each below `end`.
  template <class Visit>
  constexpr void for_each(std::size_t end, Visit&& visit) const {
    for (std::size_t word = 0; word * 64 < end; ++word) {
      for (std::uint64_t left = pairs_[word]; left != 0; left &= left - 1) {
        const std::size_t pair = 64 * word + static_cast<std::size_t>(std::countr_zero(left));
        if (pair >= end) return;
        visit(pair);
      }
    }
  }

  friend constexpr bool operator==(const ContactCandidates&, const ContactCandidates&) = default;

 private:
  std::array<std::uint64_t, capacity / 64> pairs_{};
};

/// The pairs that can touch within a tick, and how long none of them needs to be looked for again.
struct ContactSearch {
  ContactCandidates candidates;
  /// Less than every gap at the next tick [m]; zero: not known. Nothing touches before motion has used it up.
  double clearance = 0.0;
};

}  // namespace flinch
