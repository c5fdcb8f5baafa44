#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// One contact of the robot with an obstacle.
struct TouchTruth {
  int body = -1;                  ///< BodyId::index(); -1: there is none
  int obstacle = -1;              ///< its place in the list of obstacles
  bool held = false;              ///< by the grip of a hand
  CartesianVector point_in_base;  ///< midway between the surfaces [m]
  CartesianVector force_in_base;  ///< on the robot [N]
  double depth = 0.0;             ///< of penetration [m]

  double strength() const { return body < 0 ? -1.0 : force_in_base.norm(); }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("body", "", self.body);
    visit("obstacle", "", self.obstacle);
    visit("held", "", self.held);
    visit("point_in_base", "m", self.point_in_base, "base");
    visit("force_in_base", "N", self.force_in_base, "base");
    visit("depth", "m", self.depth);
  }
};

/// Whether and how obstacles touch the robot, as it really is. A contact lasts from the first penetration of
/// any body to the last; one that begins and ends between two ticks is not seen.
struct ContactTruth {
  static constexpr std::size_t further_touches = 4;

  Time acquired{};
  bool valid = false;
  bool in_contact = false;
  bool clamping = false;  ///< two bodies of one leg touch one obstacle
  int touch_count = 0;    ///< contacts at this instant; the strongest six are listed
  TouchTruth strongest;   ///< the contact with the greatest force
  TouchTruth second;      ///< the next one
  std::array<TouchTruth, further_touches> further;  ///< those after it
  PlatformVector wrench_in_base;                    ///< what all contacts do to the platform

  bool pushed = false;          ///< an applied wrench acts, without anything that touches
  PlatformVector push_in_base;  ///< that wrench

  std::int64_t contacts = 0;  ///< begun so far; while it is 0 the next three mean nothing
  Time onset{};               ///< when the present or latest contact began, interpolated between ticks
  Time end{};                 ///< likewise when it ended; while it lasts, the present
  double peak_force = 0.0;    ///< greatest force of any single contact at the ticks since onset [N]

  bool self_contact = false;           ///< bodies of the robot touch one another
  int self_body = -1;                  ///< BodyId::index() of one that does; -1: none
  int self_other = -1;                 ///< and of the other
  PlatformVector self_wrench_in_base;  ///< what that does to the platform

  /// No contact, of a robot with `dof` coordinates in a space of `directions`.
  void clear(int dof, int directions) {
    *this = ContactTruth();
    wrench_in_base.setZero(dof);
    push_in_base.setZero(dof);
    self_wrench_in_base.setZero(dof);
    for (TouchTruth* touch : listed()) {
      touch->point_in_base.setZero(directions);
      touch->force_in_base.setZero(directions);
    }
  }

  /// Takes one more contact into the list, which is in the order of their forces. Of forces that differ by
  /// rounding alone, as of bodies with one surface, the one taken first stays in front.
  void add(TouchTruth touch) {
    constexpr double rounding = 1e-9;
    ++touch_count;
    for (TouchTruth* place : listed()) {
      const double there = place->strength();
      if (touch.strength() > there + rounding * std::abs(there)) std::swap(touch, *place);
    }
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("in_contact", "", self.in_contact);
    visit("clamping", "", self.clamping);
    visit("touch_count", "", self.touch_count);
    visit("strongest", "", self.strongest);
    visit("second", "", self.second);
    visit("further", "", self.further);
    visit("wrench_in_base", "<wrench>", self.wrench_in_base, "base");
    visit("pushed", "", self.pushed);
    visit("push_in_base", "<wrench>", self.push_in_base, "base");
    visit("contacts", "", self.contacts);
    visit("onset", "ns", self.onset);
    visit("end", "ns", self.end);
    visit("peak_force", "N", self.peak_force);
    visit("self_contact", "", self.self_contact);
    visit("self_body", "", self.self_body);
    visit("self_other", "", self.self_other);
    visit("self_wrench_in_base", "<wrench>", self.self_wrench_in_base, "base");
  }

 private:
  std::array<TouchTruth*, 2 + further_touches> listed() {
    return {&strongest, &second, &further[0], &further[1], &further[2], &further[3]};
  }
};

}  // namespace flinch
