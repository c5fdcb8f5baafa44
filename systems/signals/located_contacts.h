#pragma once

#include <array>

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Where on a body and how hard something pushes.
struct LocatedContact {
  int body = -1;                  ///< BodyId::index(); -1: none
  double fraction = 0.0;          ///< of a link's axis, from its proximal joint on; 0 for the platform
  CartesianVector point_in_base;  ///< on the outline [m]
  CartesianVector force_in_base;  ///< on the robot [N]
  double point_deviation = 0.0;   ///< [m]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("body", "", self.body);
    visit("fraction", "1", self.fraction);
    visit("point_in_base", "m", self.point_in_base, "base");
    visit("force_in_base", "N", self.force_in_base, "base");
    visit("point_deviation", "m", self.point_deviation);
  }
};

/// One or two contacts that explain a wrench and what the base joints bear.
struct LocatedContacts {
  /// After so long from the detection they are judged by [s].
  static constexpr double settled = 0.02;

  Time acquired{};     ///< of the readings that they tell of
  bool valid = false;  ///< There is something to locate. Otherwise nothing below means anything.
  int count = 0;       ///< of `contacts` that are used; 0: neither one nor two explain what is felt
  /// ln of how many times likelier two are than one, before either is believed to be the rule.
  double log_odds_of_two = 0.0;
  std::array<LocatedContact, 2> contacts{};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("count", "", self.count);
    visit("log_odds_of_two", "1", self.log_odds_of_two);
    visit("contacts", "", self.contacts);
  }
};

}  // namespace flinch
