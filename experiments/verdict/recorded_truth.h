#pragma once

#include <Eigen/Core>
#include <array>

#include "systems/robot/vectors.h"

/// What of a simulation's truth verdict and report look at. A recording is read without what made it: these
/// are the fields of those names, read from its signals "truth", "contact" and "obstacles".
namespace flinch {

struct RecordedTruth {
  Configuration pose;             ///< in the base frame
  PlatformVector velocity;        ///< likewise
  PlatformVector wrench_in_base;  ///< all that acts from outside
  JointVector active;             ///< positions of the drives
  JointVector drive_torque;
  double loop_closure_error = 0.0;  ///< [m]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("pose", "<pose>", self.pose, "base");
    visit("velocity", "<velocity>", self.velocity, "base");
    visit("wrench_in_base", "<wrench>", self.wrench_in_base, "base");
    visit("active", "<drive position>", self.active);
    visit("drive_torque", "<drive force>", self.drive_torque);
    visit("loop_closure_error", "m", self.loop_closure_error);
  }
};

struct RecordedTouch {
  int obstacle = -1;              ///< its place in the list of obstacles
  int body = -1;                  ///< BodyId::index(); -1: none
  CartesianVector point_in_base;  ///< [m]
  CartesianVector force_in_base;  ///< on the robot [N]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("body", "", self.body);
    visit("obstacle", "", self.obstacle);
    visit("point_in_base", "m", self.point_in_base, "base");
    visit("force_in_base", "N", self.force_in_base, "base");
  }
};

struct RecordedContact {
  bool in_contact = false;
  bool clamping = false;  ///< both links of one leg touch
  RecordedTouch strongest;
  RecordedTouch second;
  PlatformVector wrench_in_base;  ///< what all of them do to the platform

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("in_contact", "", self.in_contact);
    visit("clamping", "", self.clamping);
    visit("strongest", "", self.strongest);
    visit("second", "", self.second);
    visit("wrench_in_base", "<wrench>", self.wrench_in_base, "base");
  }
};

/// Read from the signal "contact", where it tells of them.
struct RecordedFurtherTouches {
  std::array<RecordedTouch, 4> further;  ///< after the second, the hardest first

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("further", "", self.further);
  }
};

/// Likewise.
struct RecordedSelfContact {
  bool self_contact = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("self_contact", "", self.self_contact);
  }
};

/// Likewise: BodyId::index() of two bodies that touch one another.
struct RecordedSelfBodies {
  int self_body = -1;
  int self_other = -1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("self_body", "", self.self_body);
    visit("self_other", "", self.self_other);
  }
};

/// Read from the signal "obstacles", where any of them may move.
struct RecordedObstacles {
  std::array<Eigen::Vector3d, 8> displacement_in_base{};  ///< from their positions at rest [m]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("displacement_in_base", "m", self.displacement_in_base, "base");
  }
};

}  // namespace flinch
