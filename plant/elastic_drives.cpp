#include "plant/elastic_drives.h"

#include <algorithm>
#include <cmath>

#include "systems/foundation/findings.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/motion_equations.h"

namespace flinch {
namespace {

constexpr double usual_rotor_share = 0.2;  // of what a drive moves
// A flank takes hold within this share of the play, so that no damping begins at once.
constexpr double flank_share = 0.05;

/// The drives of a robot at rest: q'' = mobility tau - fall. A maps v to their rates q'.
struct DrivesAtRest {
  PlatformMatrix mobility;  ///< A M^-1 A^T
  JointVector fall;         ///< A M^-1 g

  DrivesAtRest(const Mechanism& robot, const Configuration& pose) {
    Kinematics kinematics;
    MotionEquations equations;
    robot.equations_of_motion(pose, PlatformVector::Zero(robot.dof()), kinematics, equations);
    const PlatformMatrix& A = kinematics.J_qa_x;
    const auto M = equations.M_x.llt();
    mobility = A * M.solve(A.transpose());
    fall = A * M.solve(equations.h_x);
  }

  /// What each drive moves while the others are free [kg m^2 or kg].
  JointVector inertia() const { return mobility.diagonal().cwiseInverse(); }
  /// Torques that hold the robot.
  JointVector holding() const { return mobility.completeOrthogonalDecomposition().solve(fall); }
};

double twist_under(double effort, double stiffness, double half_play) {
  return effort == 0.0 ? 0.0 : effort / stiffness + std::copysign(half_play, effort);
}

}  // namespace

std::vector<std::string> problems(const ElasticDrivesSettings& settings, const Mechanism& robot,
                                  const Configuration& start) {
  const int drives = robot.drives();
  Findings found("elastic_drives.");
  const std::string each = " number for each of the " + std::to_string(drives) + " drives, or none at all";
  const auto check = [&](const char* name, const JointVector& values, bool in_range) {
    const bool all = values.size() == 0 || usable(values, drives);
    found.require(all && in_range, name + each);
  };
  check("stiffness needs a positive", settings.stiffness, (settings.stiffness.array() > 0.0).all());
  check("backlash needs a not negative", settings.backlash, (settings.backlash.array() >= 0.0).all());
  check("rotor_inertia needs a positive", settings.rotor_inertia,
        (settings.rotor_inertia.array() > 0.0).all());
  found.not_negative("damping_ratio", settings.damping_ratio);
  if (!found.none() || settings.rotor_inertia.size() == 0) return found.take();
  const DrivesAtRest at_rest(robot, start);
  const JointVector root = settings.rotor_inertia.cwiseSqrt();
  const PlatformMatrix rest =
      PlatformMatrix::Identity(drives, drives) - root.asDiagonal() * at_rest.mobility * root.asDiagonal();
  if (rest.llt().info() != Eigen::Success) {
    found.add("rotor_inertia is more than all that a drive moves, " +
              std::to_string(at_rest.inertia().minCoeff()) +
              " at least where the robot begins; it is a part of that");
  }
  return found.take();
}

ElasticDrives::ElasticDrives(const ElasticDrivesSettings& settings, const Mechanism& robot,
                             const Configuration& start) {
  if (!settings.any()) return;
  const DrivesAtRest at_rest(robot, start);
  const JointVector moved = at_rest.inertia();
  const JointVector holding = at_rest.holding();
  for (int i = 0; i < robot.drives(); ++i) {
    const double k = settings.stiffness[i];
    const double rotor =
        settings.rotor_inertia.size() > 0 ? settings.rotor_inertia[i] : usual_rotor_share * moved[i];
    const double reduced = rotor * (moved[i] - rotor) / moved[i];
    const double half_play = settings.backlash.size() > 0 ? 0.5 * settings.backlash[i] : 0.0;
    springs_.push_back({.stiffness = k,
                        .damping = 2.0 * settings.damping_ratio * std::sqrt(k * reduced),
                        .half_play = half_play,
                        .rotor_inertia = rotor,
                        .twist_at_start = twist_under(holding[i], k, half_play)});
  }
}

double ElasticDrives::Spring::beyond_flank(double twist) const noexcept {
  return twist - std::clamp(twist, -half_play, half_play);
}

double ElasticDrives::effort(int drive, double twist, double twist_rate) const noexcept {
  const Spring& s = spring(drive);
  const double beyond = s.beyond_flank(twist);
  if (s.half_play == 0.0) return s.stiffness * beyond + s.damping * twist_rate;
  const double depth = std::abs(beyond);
  const double hold = depth / (depth + flank_share * 2.0 * s.half_play);
  const double push = s.stiffness * depth + std::copysign(hold * s.damping, beyond) * twist_rate;
  return std::copysign(std::max(push, 0.0), beyond);
}

double ElasticDrives::energy(int drive, double twist) const noexcept {
  const Spring& s = spring(drive);
  const double beyond = s.beyond_flank(twist);
  return 0.5 * s.stiffness * beyond * beyond;
}

}  // namespace flinch
