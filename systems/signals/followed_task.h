#pragma once

#include <cstdint>

namespace flinch {

/// What a reaction does about a contact. [SafePR] (26)-(31)
enum class ReactionKind : std::uint8_t {
  brake,       ///< nothing to give way to: what touches the robot is not known, or the force has no direction
  retreat,     ///< the same, but the robot ran into it: the platform goes back the way it came
  platform,    ///< the platform moves along the force
  first_link,  ///< the drive of a first link turns away
  second_link,  ///< the point that is touched moves along the force; the far end of a leg that slides
  opening,      ///< the links of a leg that clamps open
};

/// The task that a reaction follows; while it holds its place, the one that led there.
struct FollowedTask {
  bool valid = false;  ///< a reaction goes on
  ReactionKind kind = ReactionKind::brake;
  int leg = -1;  ///< of a link that is led, or a leg that opens

  bool operator==(const FollowedTask&) const = default;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("kind", "", self.kind);
    visit("leg", "", self.leg);
  }
};

}  // namespace flinch
