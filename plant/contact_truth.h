#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// One contact of the robot with the pylon.
struct TouchTruth {
  int body = -1;                            ///< BodyId::index(); -1: there is none
  Eigen::Vector2d point_in_base{0.0, 0.0};  ///< midway between the surfaces [m]
  Eigen::Vector2d force_in_base{0.0, 0.0};  ///< on the robot [N]
  double depth = 0.0;                       ///< of penetration [m]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("body", "", self.body);
    visit("point_in_base", "m", self.point_in_base, "base");
    visit("force_in_base", "N", self.force_in_base, "base");
    visit("depth", "m", self.depth);
  }
};

/// Whether and how the pylon touches the robot, as it really is. A contact lasts from the first penetration
/// of any body to the last; one that begins and ends between two ticks is not seen.
struct ContactTruth {
  Time acquired{};
  bool valid = false;
  bool in_contact = false;
  bool clamping = false;          ///< both links of one leg touch
  TouchTruth strongest;           ///< the contact with the greatest force
  TouchTruth second;              ///< the next one
  PlatformVector wrench_in_base;  ///< what all contacts do to the platform [N, N, Nm]

  std::int64_t contacts = 0;  ///< begun so far; while it is 0 the next three mean nothing
  Time onset{};               ///< when the present or latest contact began, interpolated between ticks
  Time end{};                 ///< likewise when it ended; while it lasts, the present
  double peak_force = 0.0;    ///< greatest force of any single contact at the ticks since onset [N]

  bool self_contact = false;           ///< bodies of the robot touch one another
  PlatformVector self_wrench_in_base;  ///< what that does to the platform [N, N, Nm]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("in_contact", "", self.in_contact);
    visit("clamping", "", self.clamping);
    visit("strongest", "", self.strongest);
    visit("second", "", self.second);
    visit("wrench_in_base", "<wrench>", self.wrench_in_base, "base");
    visit("contacts", "", self.contacts);
    visit("onset", "ns", self.onset);
    visit("end", "ns", self.end);
    visit("peak_force", "N", self.peak_force);
    visit("self_contact", "", self.self_contact);
    visit("self_wrench_in_base", "<wrench>", self.self_wrench_in_base, "base");
  }
};

}  // namespace flinch
