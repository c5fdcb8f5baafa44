#pragma once

#include "systems/robot/kinematics.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// What a controller may want of a robot at one instant: a function sigma of the configuration, how it
/// changes with the platform, and how it accelerates by itself. [SafePR] IV-B
///
///   dsigma = J v,   ddsigma = J dv + drift,   drift = dJ/dt v
///
/// One row an entry of sigma, at most `max_dof`. Units are those of sigma. J stays finite at type-II
/// singularities. Where the task is not valid it has its rows, and they are zero.
struct Task {
  PlatformVector sigma;
  PlatformMatrix J;      ///< rows x n
  PlatformVector drift;  ///< dJ/dt v
  bool valid = false;

  int rows() const { return static_cast<int>(sigma.size()); }
  /// dsigma for the platform's velocity `v`.
  PlatformVector rate(const PlatformVector& v) const { return J * v; }
};

/// Where a task shall be, seen from where it is.
struct TaskReference {
  PlatformVector error;         ///< sigma_d - sigma, angles the shorter way
  PlatformVector rate;          ///< dsigma_d
  PlatformVector acceleration;  ///< ddsigma_d
};

/// A task of `rows` rows that is zero and not valid, for a platform with `dof` coordinates.
Task no_task(int rows, int dof) noexcept;

/// The share of a vector task along `direction`, which has its rows: sigma = n^T sigma. [SafePR] (27), (30)
Task along(const Task& task, const PlatformVector& direction) noexcept;

/// The rows of `first`, then those of `second`; valid if both are. The rows must not be more than `max_dof`.
Task stacked(const Task& first, const Task& second) noexcept;

/// The same task seen from the drives.
///
///   dsigma = J_qa dq_a,   ddsigma = J_qa ddq_a + drift_qa,   J_qa = J J_x,qa,   drift_qa = d(J_qa)/dt dq_a
struct DriveTask {
  PlatformMatrix J;      ///< rows x drives
  PlatformVector drift;  ///< dJ_qa/dt dq_a
  bool valid = false;
};

/// Not valid, and zero, where the task or the kinematics is not.
DriveTask seen_by_drives(const Task& task, const Kinematics& kinematics) noexcept;

}  // namespace flinch
