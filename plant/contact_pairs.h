#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "systems/robot/body_id.h"

namespace flinch {

/// A disc and a body that may touch. Links meet where a joint of one leg, a disc as thick as its links, meets
/// a link of another. Left out are neighbours along a leg, which always overlap, and the platform with second
/// links, which are joined to it.
struct ContactPair {
  enum class Round : std::uint8_t { pylon, platform, base_joint, passive_joint, coupling_joint };
  enum class Against : std::uint8_t { platform, leg, link1, link2 };

  Round round{};
  int round_leg = -1;  ///< Of a joint.
  Against against{};
  int leg = -1;  ///< Of the links.
};

inline constexpr std::size_t contact_pair_count = 31;
inline constexpr std::size_t pylon_pair_count = 4;  ///< They come first.

namespace internal {

constexpr std::array<ContactPair, contact_pair_count> list_contact_pairs() {
  using Round = ContactPair::Round;
  using Against = ContactPair::Against;
  std::array<ContactPair, contact_pair_count> pairs{};
  std::size_t count = 0;
  pairs[count++] = {Round::pylon, -1, Against::platform, -1};
  for (int leg = 0; leg < 3; ++leg) pairs[count++] = {Round::pylon, -1, Against::leg, leg};
  for (const Round joint : {Round::base_joint, Round::passive_joint, Round::coupling_joint}) {
    for (int round_leg = 0; round_leg < 3; ++round_leg) {
      for (int leg = 0; leg < 3; ++leg) {
        if (leg != round_leg) pairs[count++] = {joint, round_leg, Against::leg, leg};
      }
    }
  }
  for (int leg = 0; leg < 3; ++leg) {
    pairs[count++] = {Round::platform, -1, Against::link1, leg};
    pairs[count++] = {Round::coupling_joint, leg, Against::link1, leg};  // a leg that folds up
    pairs[count++] = {Round::base_joint, leg, Against::link2, leg};
  }
  return pairs;
}

}  // namespace internal

inline constexpr std::array<ContactPair, contact_pair_count> contact_pairs = internal::list_contact_pairs();

/// Some of the pairs: those that can touch within a tick.
class ContactCandidates {
 public:
  constexpr ContactCandidates() = default;
  static constexpr ContactCandidates all() {
    return ContactCandidates((std::uint32_t{1} << contact_pair_count) - 1);
  }

  constexpr void add(std::size_t pair) { pairs_ |= std::uint32_t{1} << pair; }
  constexpr bool contains(std::size_t pair) const { return (pairs_ >> pair & 1U) != 0; }
  constexpr int count() const { return std::popcount(pairs_); }

  /// Calls visit(pair) for each.
  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    for (std::uint32_t left = pairs_; left != 0; left &= left - 1) {
      visit(contact_pairs[static_cast<std::size_t>(std::countr_zero(left))]);
    }
  }

  friend constexpr bool operator==(ContactCandidates, ContactCandidates) = default;

 private:
  explicit constexpr ContactCandidates(std::uint32_t pairs) : pairs_(pairs) {}

  std::uint32_t pairs_ = 0;
};

}  // namespace flinch
