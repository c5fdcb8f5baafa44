#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "systems/robot/body_dynamics.h"
#include "systems/robot/parallel_robot.h"

namespace flinch::test {

/// A robot at one instant.
struct MotionState {
  Configuration pose;
  PlatformVector velocity;
};

/// A force on a body at a point, both in the base frame.
struct Push {
  BodyId body;
  Eigen::Vector3d point;
  Eigen::Vector3d force;
};

/// What drives and surroundings do to a robot at one instant.
struct Loads {
  JointVector drives;
  PlatformVector wrench;
  std::vector<Push> pushes;
};

/// Residuals that central differences leave; the widest of what the mechanisms' formulas were checked with.
struct Tolerances {
  double step = 3e-4;  ///< Of the differences.
  double drive_map = 1e-10;
  double drive_map_rate = 1e-10;
  double contact = 3e-10;
  double contact_rate = 4e-10;
  double mass_rate = 4e-9;
  double momentum = 2e-9;
  double gravity = 2e-10;
  double acceleration = 1e-10;
};

/// A mechanism with one set of parameters, as the laws see it, and the same robot once more as bodies that
/// constraints hold together.
struct MechanismCase {
  std::string name;
  std::shared_ptr<const ParallelRobot> robot;
  PlatformVector region;    ///< Half widths of the increments from home within which poses are drawn.
  PlatformVector velocity;  ///< Largest velocities drawn.
  double least_det_A = 0.0;
  /// By index; planar ones in the plane z = 0. Empty: laws that compare with the bodies are left out.
  std::vector<RigidBodyInertia> bodies;
  /// How many of 2000 random starts at least lead to another branch; 0 where there is none.
  int least_jumps = 21;
  /// By how much drives may disagree at a pose that is taken for theirs [rad or m]; more drives than
  /// coordinates never agree quite.
  double largest_disagreement = 1e-9;
  double armature = 0.0;  ///< Of every drive, where it is none of the bodies' inertia.
  /// Acceleration of the platform from maximal coordinates, as ConstrainedBodies gives it; none: laws that
  /// compare with it are left out.
  std::function<PlatformVector(const MotionState&, const Loads&)> reference;
  Tolerances tolerances;
};

/// Every mechanism and parameter set that the laws are to try; whoever links them says which.
const std::vector<MechanismCase>& mechanism_cases();

inline std::string case_name(const ::testing::TestParamInfo<MechanismCase>& info) { return info.param.name; }
inline void PrintTo(const MechanismCase& mechanism, std::ostream* out) { *out << mechanism.name; }

}  // namespace flinch::test
