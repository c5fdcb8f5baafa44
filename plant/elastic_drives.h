#pragma once

#include <string>
#include <vector>

#include "systems/robot/mechanism.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Springs with play between motors and legs, one a drive: gears, belts and shafts, and links that bend.
struct ElasticDrivesSettings {
  JointVector stiffness{};  ///< [Nm/rad or N/m]; empty: motors and legs are one.
  JointVector backlash{};   ///< From one flank to the other [rad or m]; empty: none.
  /// Of each motor [kg m^2 or kg], a part of what the robot says that its drives move; empty: a fifth of what
  /// each moves at home while the others are free.
  JointVector rotor_inertia{};
  double damping_ratio = 0.02;  ///< Of each spring between its rotor and its leg at home.

  bool any() const { return stiffness.size() > 0; }
};

/// All that is wrong with `settings` for `robot`, which begins at `start`.
std::vector<std::string> problems(const ElasticDrivesSettings& settings, const Mechanism& robot,
                                  const Configuration& start);

/// The two-mass model of a drive: J_m theta'' = tau_m - tau_s and tau_s = k (theta - q) + d (theta' - q') on
/// the leg. M. W. Spong, Modeling and control of elastic joint robots, 1987, doi:10.1115/1.3143860. With
/// backlash nothing is passed on between the flanks, and nothing is pulled.
class ElasticDrives {
 public:
  /// Motors and legs are one.
  ElasticDrives() = default;
  /// `settings` without problems; `start` is within reach.
  ElasticDrives(const ElasticDrivesSettings& settings, const Mechanism& robot, const Configuration& start);

  bool any() const noexcept { return !springs_.empty(); }
  /// Torque on the leg of `drive` at a `twist` by which its motor is ahead [rad or m], and its rate.
  double effort(int drive, double twist, double twist_rate) const noexcept;
  /// At which it holds the robot where it begins.
  double twist_at_start(int drive) const noexcept { return spring(drive).twist_at_start; }
  double energy(int drive, double twist) const noexcept;  ///< [J]
  double rotor_inertia(int drive) const noexcept { return spring(drive).rotor_inertia; }

 private:
  struct Spring {
    double stiffness, damping, half_play, rotor_inertia, twist_at_start;

    /// By how much a twist is beyond its flank; 0 between both.
    double beyond_flank(double twist) const noexcept;
  };
  const Spring& spring(int drive) const noexcept { return springs_[static_cast<std::size_t>(drive)]; }

  std::vector<Spring> springs_;
};

}  // namespace flinch
