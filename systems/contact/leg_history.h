#pragma once

#include <array>
#include <optional>

#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_window.h"

namespace flinch {

/// What of a wrench a leg would feel, and how it moves.
struct LegMoment {
  /// In deviations of an estimated wrench: of what something between the links pushes on the first link, of
  /// what else it pushes on the second, and size of what is left.
  double link1_force = 0.0, link2_force = 0.0, other_force = 0.0;
  double link1_speed = 0.0, link2_speed = 0.0;  ///< of the middle of each towards the other link [m/s]
};

/// A course in coordinates of a leg, in which it looks alike whichever leg it is and wherever it stands.
struct LegHistory {
  double elbow_cosine = 0.0;  ///< of the angle between the links
  std::array<LegMoment, window_ages.size()> moments{};
};
using LegCourses = std::array<LegHistory, max_dof>;

/// The course in coordinates of each leg in the pose of now; zeros for legs without two links, and for those
/// whose links lie in one line. Nothing where the pose is not valid or a moment has another size. Never
/// allocates. (Derived.)
std::optional<LegCourses> leg_histories(const ParallelRobot& robot, const Kinematics& now,
                                        const ContactMoments& moments) noexcept;

}  // namespace flinch
