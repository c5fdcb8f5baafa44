#include "systems/robot/workspace_limits.h"

#include <cmath>
#include <string>

#include "systems/foundation/findings.h"
#include "systems/foundation/quantity_text.h"
#include "systems/robot/link_segments.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

// Limits that do not allow what the robot does at home. NaN allows nothing.
class LimitsAtHome {
 public:
  void least(const char* field, double limit, double at_home, const char* unit) {
    if (!(limit <= at_home)) add(field, limit, unit, "must be at most", at_home);
  }
  void most(const char* field, double limit, double at_home, const char* unit) {
    if (!(limit >= at_home)) add(field, limit, unit, "must be at least", at_home);
  }
  std::vector<std::string> take() { return findings_.take(); }

 private:
  void add(const char* field, double limit, const char* unit, const char* expectation, double at_home) {
    findings_.add(field, limit, unit,
                  std::string(expectation) + " that at the home pose, " + quantity_text(at_home, unit));
  }

  Findings findings_;
};

}  // namespace

double distance_from_centre(const WorkspaceLimits& limits, const Mechanism& mechanism,
                            const Configuration& pose) noexcept {
  const int translations = mechanism.space().translations();
  const CartesianVector position = pose.head(translations);
  return limits.centre.size() == translations ? (position - limits.centre).norm() : position.norm();
}

bool is_within(const WorkspaceLimits& limits, const Mechanism& mechanism,
               const Kinematics& kinematics) noexcept {
  const JointVector& drives = kinematics.joints.active;
  return kinematics.valid && std::abs(kinematics.det_A) >= limits.min_abs_det_A &&
         std::abs(kinematics.det_B) >= limits.min_abs_det_B &&
         distance_from_centre(limits, mechanism, kinematics.pose) <= limits.max_distance &&
         mechanism.space().rotation_angle(kinematics.pose) <= limits.max_rotation &&
         drives.minCoeff() >= limits.min_active && drives.maxCoeff() <= limits.max_active &&
         self_collision_distance(mechanism, kinematics) >= limits.min_self_collision_distance &&
         mechanism.platform_gap(kinematics) >= limits.min_platform_gap;
}

std::vector<std::string> problems(const WorkspaceLimits& limits, const ParallelRobot& robot) {
  const Configuration& pose = robot.home_pose();
  Kinematics home;
  robot.kinematics(pose, PlatformVector::Zero(robot.dof()), home);

  LimitsAtHome findings;
  findings.most("max_distance", limits.max_distance, distance_from_centre(limits, robot, pose), "m");
  findings.most("max_rotation", limits.max_rotation, robot.space().rotation_angle(pose), "rad");
  findings.least("min_abs_det_A", limits.min_abs_det_A, std::abs(home.det_A), "");
  findings.least("min_abs_det_B", limits.min_abs_det_B, std::abs(home.det_B), "");
  findings.least("min_self_collision_distance", limits.min_self_collision_distance,
                 self_collision_distance(robot, home), "m");
  findings.least("min_platform_gap", limits.min_platform_gap, robot.platform_gap(home), "m");
  const bool turns = robot.drive_kind(0) == DriveKind::revolute;
  const char* const unit = turns ? "rad" : "m";
  findings.least(turns ? "min_active_angle" : "min_active_length", limits.min_active,
                 home.joints.active.minCoeff(), unit);
  findings.most(turns ? "max_active_angle" : "max_active_length", limits.max_active,
                home.joints.active.maxCoeff(), unit);
  return findings.take();
}

}  // namespace flinch
