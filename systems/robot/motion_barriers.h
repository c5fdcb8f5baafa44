#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "systems/robot/mechanism.h"
#include "systems/robot/workspace_limits.h"

/// What keeps a robot within its limits: functions that are positive inside.
namespace flinch {

/// Where a robot may be. Limits that allow everything have no barrier.
struct PoseConstraints {
  WorkspaceLimits workspace;
  double max_condition_number = std::numeric_limits<double>::infinity();  ///< sigma_kappa
};

/// By how much inside its limits a robot is kept, since its model and what it measures are not exact.
struct LimitMargins {
  double condition_number = 0.4;
  double angle = 0.0105;    ///< of rotation and of coupling joints: 0.6 degrees [rad]
  double distance = 0.003;  ///< of the platform from the centre [m]
  double share = 0.03;      ///< of determinants, and of sigma_sc where that has no closed form
  double range = 0.005;     ///< at each end, as a share of a drive's range
};

/// What a barrier stands before.
enum class BarrierKind : std::uint8_t {
  condition_number,
  type_1_singularity,
  type_2_singularity,
  self_collision,
  distance,
  rotation,
  drive_range,
};

/// One limit at one instant: room h to it, which is zero on it, and how h changes with the platform's motion.
///
///   dh = gradient^T v,   ddh = gradient^T dv + drift
struct Barrier {
  BarrierKind kind = BarrierKind::condition_number;
  double room = 0.0;        ///< h: of a logarithm for condition number and determinants [rad, m or none]
  PlatformVector gradient;  ///< dh/dx
  double drift = 0.0;       ///< v^T d^2h/dx^2 v
};

/// Every barrier of a robot, in an order that depends on its limits alone.
struct BarrierList {
  static constexpr int most = 2 * max_dof + 12;
  std::array<Barrier, most> all;
  int count = 0;
  bool valid = false;  ///< the robot can be there, and every number is finite

  void add(const Barrier& barrier) { all[static_cast<std::size_t>(count++)] = barrier; }
  const Barrier& operator[](int i) const { return all[static_cast<std::size_t>(i)]; }
};

/// The barriers of `limits`, `margins` inside of them, at this motion. sigma_kappa counts by its smooth upper
/// bound; sigma_sc by the angles of the coupling joints where it follows from them, otherwise by the distance
/// of the nearest links. Not valid, with as many barriers as could be told, where the kinematics is not.
void evaluate_barriers(const Mechanism& mechanism, const Kinematics& kinematics,
                       const PoseConstraints& limits, const LimitMargins& margins, BarrierList& out) noexcept;

}  // namespace flinch
