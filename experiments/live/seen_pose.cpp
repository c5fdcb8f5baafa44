#include "experiments/live/seen_pose.h"

#include <fmt/core.h>

namespace flinch {
namespace {

constexpr double degrees = 57.29577951308232;  // [deg/rad]
constexpr double plausible_closure = 0.01;     // above it the control path refuses the pose [m]

std::string in_degrees(const JointVector& angles) {
  std::string list;
  for (const double angle : angles)
    list += fmt::format("{}{:.2f}", list.empty() ? "" : ", ", degrees * angle);
  return list + " deg";
}

std::string in_millimetres(const JointVector& lengths) {
  std::string list;
  for (const double length : lengths) list += fmt::format("{}{:.2f}", list.empty() ? "" : ", ", 1e3 * length);
  return list + " mm";
}

/// Position, then rotation vector, both against the base frame.
std::string in_units(const PlatformVector& from_base, Eigen::Index lengths) {
  std::string list;
  for (Eigen::Index i = 0; i < from_base.size(); ++i) {
    list +=
        fmt::format("{}{:.1f} {}", i == 0 ? "" : ", ",
                    i < lengths ? 1e3 * from_base[i] : degrees * from_base[i], i < lengths ? "mm" : "deg");
  }
  return list;
}

}  // namespace

SeenPose see_pose(const ParallelRobot& robot, const JointReading& joints) {
  SeenPose seen{.space = robot.space(),
                .drives = robot.drive_kind(0),
                .joints = joints,
                .platform = {},
                .closure_error = {}};
  if (!joints.valid || joints.active.size() != robot.drives()) return seen;
  const bool has_passive =
      robot.passive_joints() > 0 && joints.passive_valid && joints.passive.size() == robot.passive_joints();
  const Configuration start =
      has_passive ? robot.start_pose(joints.active, joints.passive) : robot.home_pose();
  const ForwardSolution found = robot.forward_kinematics(joints.active, start, robot.home_working_mode());
  if (!found.converged) return seen;
  seen.platform = found.pose;
  if (has_passive) {
    seen.closure_error = robot.chain_closure_error(joints.active, joints.passive, found.pose);
  }
  return seen;
}

std::string SeenPose::text() const {
  if (!joints.valid) return "robot     no angles of the drives that can be used\n";
  const bool turns = drives == DriveKind::revolute;
  std::string text =
      "robot     drives at " + (turns ? in_degrees(joints.active) : in_millimetres(joints.active));
  if (joints.passive_valid && joints.passive.size() > 0) text += "; elbows at " + in_degrees(joints.passive);
  text += "\n          ";
  if (!platform || !space)
    return text + "these drive angles fit no pose of the platform: check signs and zeros\n";
  text += "platform at " + in_units(space->difference(*platform, space->origin()), space->translations());
  if (closure_error) {
    text += fmt::format("; the elbows miss it by {:.1f} mm", 1e3 * *closure_error);
    if (*closure_error > plausible_closure) text += ": check signs and zeros";
  }
  return text + "\n";
}

}  // namespace flinch
