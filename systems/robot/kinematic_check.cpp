#include "systems/robot/kinematic_check.h"

namespace flinch {
namespace {

/// The working modes that differ from `mode` in the legs of `flipped`.
WorkingMode flipped_mode(const WorkingMode& mode, unsigned flipped) {
  WorkingMode other = mode;
  for (int leg = 0; leg < other.size(); ++leg) {
    if ((flipped >> static_cast<unsigned>(leg) & 1U) != 0) other[leg] = 1 - other[leg];
  }
  return other;
}

/// The pose in a working mode as near to `mode` as there is one, which is then in `mode`.
bool follow(const ParallelRobot& robot, const JointVector& active, Configuration& pose, WorkingMode& mode) {
  const unsigned modes = 1U << static_cast<unsigned>(mode.size());
  for (unsigned flipped = 0; flipped < modes; ++flipped) {
    const WorkingMode tried = flipped_mode(mode, flipped);
    const ForwardSolution solution = robot.forward_kinematics(active, pose, tried);
    if (!solution.converged) continue;
    pose = solution.pose;
    mode = tried;
    return true;
  }
  return false;
}

}  // namespace

std::vector<KinematicCheck::Fold> KinematicCheck::folds() const {
  std::vector<Fold> folds;
  for (std::size_t i = 1; i < stretches.size(); ++i) {
    const WorkingMode &before = stretches[i - 1].mode, &mode = stretches[i].mode;
    for (int leg = 0; leg < mode.size(); ++leg) {
      if (mode[leg] != before[leg]) folds.push_back({leg, stretches[i].first});
    }
  }
  return folds;
}

KinematicCheck check_kinematics(const ParallelRobot& robot, const std::vector<JointVector>& active) {
  KinematicCheck check;
  WorkingMode mode = robot.home_working_mode();
  Configuration pose = robot.home_pose();
  std::size_t valid = 0;
  for (std::size_t row = 0; row < active.size(); ++row) {
    bool found = follow(robot, active[row], pose, mode);
    if (!found) {
      Configuration again = robot.home_pose();
      found = follow(robot, active[row], again, mode);
      if (found) pose = again;
    }
    if (!found) continue;
    ++valid;
    const bool begins = check.stretches.empty() || check.stretches.back().mode != mode;
    if (begins) check.stretches.push_back({mode, pose, row});
  }
  if (!active.empty()) check.valid_fraction = static_cast<double>(valid) / static_cast<double>(active.size());
  return check;
}

}  // namespace flinch
