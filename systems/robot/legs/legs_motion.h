#pragma once

#include "systems/robot/legs/closure_factor.h"
#include "systems/robot/legs/legs_model.h"

namespace flinch {

/// One row a coordinate of a leg, one column a platform coordinate.
using CoordinateMap = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_leg_coordinates, max_dof>;

/// A leg at an instant: ds/dt = G v.
struct LegMotion {
  LegCoordinates s_rate;
  ChainPlace place;
  ChainRates rates;
  ClosureFactor factor;
  ClosureMatrix dJ;
  CoordinateMap G;
  CoordinateMap dG;

  /// Where the joints are, and J.
  void start(const ModelLeg& leg, const LegCoordinates& s) noexcept;
  /// G of the twist map of the platform, and the rates of the joints.
  void set_map(const ModelLeg& leg, const PlatformTwist& platform, const PlatformVector& v) noexcept;
  /// dG, after these.
  void set_map_rate(const ModelLeg& leg, const PlatformTwist& platform) noexcept;
  /// d ln |det J| / dt
  double determinant_rate() const noexcept { return factor.determinant_rate(dJ); }
};

/// The robot at an instant.
struct LegsMotion {
  PlatformTwist platform;
  std::array<LegMotion, max_dof> legs;
  double rest_determinant = 1.0;  ///< Of what determines the following numbers, by that at home; 1 without.

  /// All of it, at a usable pose with the coordinates that assemble() found.
  void set(const LegsModel& model, const Configuration& pose, const PlatformVector& v,
           const LegsState& state) noexcept;
  /// The same for the platform alone where it suffices, which it does unless chart numbers follow.
  void set_platform(const LegsModel& model, const Configuration& pose, const PlatformVector& v,
                    const LegsState& state) noexcept;
  /// The same for one leg besides.
  void set_for(const LegsModel& model, const Configuration& pose, const PlatformVector& v,
               const LegsState& state, std::size_t leg) noexcept;

 private:
  void set_following(const LegsModel& model, const Configuration& pose, const PlatformVector& v,
                     const LegsState& state) noexcept;
};

/// Positions of the drives, angles in (-pi, pi].
JointVector drive_positions(const LegsModel& model, const LegsState& state) noexcept;
/// A with rates of the drives = A v, and its time derivative.
void set_drive_map(const LegsModel& model, const LegsMotion& motion, PlatformMatrix& A,
                   PlatformMatrix& dA) noexcept;

/// T and dT of a platform none of whose chart numbers follow, and its twist.
void set_twist(const LegsModel& model, const PlatformVector& v, PlatformTwist& platform) noexcept;

}  // namespace flinch
