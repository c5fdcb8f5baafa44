#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace flinch {

/// A disc and the bodies of a planar 3-RRR that it may touch. Links meet where a joint of one leg, a disc as
/// thick as its links, meets a link of another. Left out are neighbours along a leg, which always overlap,
/// and the platform with second links, which are joined to it. GeneralRig goes by the robot's description,
/// which pairs links of different legs only: neither the platform with first links nor a leg that folds up.
struct PlanarPair {
  enum class Round : std::uint8_t { obstacle, platform, base_joint, passive_joint, coupling_joint };
  enum class Against : std::uint8_t { platform, leg, link1, link2 };

  Round round{};
  int which = -1;  ///< The leg of a joint; the place of an obstacle in the list.
  Against against{};
  int leg = -1;  ///< Of the links.
};

inline constexpr std::size_t planar_self_pairs = 27;
inline constexpr std::size_t planar_pairs_of_obstacle = 4;

namespace internal {

constexpr std::array<PlanarPair, planar_self_pairs> list_planar_pairs() {
  using Round = PlanarPair::Round;
  using Against = PlanarPair::Against;
  std::array<PlanarPair, planar_self_pairs> pairs{};
  std::size_t count = 0;
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

inline constexpr std::array<PlanarPair, planar_self_pairs> planar_self_pair_list = list_planar_pairs();

}  // namespace internal

/// The pair of a number: the robot's own pairs first, then those of each obstacle.
constexpr PlanarPair planar_pair(std::size_t number) {
  if (number < planar_self_pairs) return internal::planar_self_pair_list[number];
  const std::size_t rest = number - planar_self_pairs;
  const int obstacle = static_cast<int>(rest / planar_pairs_of_obstacle);
  const int leg = static_cast<int>(rest % planar_pairs_of_obstacle) - 1;
  return {PlanarPair::Round::obstacle, obstacle,
          leg < 0 ? PlanarPair::Against::platform : PlanarPair::Against::leg, leg};
}

}  // namespace flinch
