#pragma once

#include "systems/robot/vectors.h"

namespace flinch {

/// The manifold on which a mechanism's configurations x lie. Velocities v and wrenches F have one entry for
/// each of its dimensions, translations first, and power is F^T v. Rotations are measured in the base frame:
/// xi moves x by a translation and then by the rotation vector, both in the base frame.
///
/// | kind         | x stored                     | v             | F                |
/// | plane        | p                            | dp            | f [N]            |
/// | space        | p                            | dp            | f [N]            |
/// | planar_pose  | (p, phi)                     | (dp, dphi)    | (f, m_z) [N, Nm] |
/// | spatial_pose | (p, w, x, y, z), unit length | (dp, omega)   | (f, m) [N, Nm]   |
///
/// p is the origin of the platform frame E [m], and the moment is about it.
class ConfigurationSpace {
 public:
  enum class Kind { plane, space, planar_pose, spatial_pose };

  constexpr ConfigurationSpace(Kind kind) : kind_(kind) {}  // NOLINT(google-explicit-constructor)

  constexpr Kind kind() const noexcept { return kind_; }
  /// n: entries of a velocity or wrench.
  constexpr int dimension() const noexcept { return translations() + rotations(); }
  /// Directions in which the platform moves: 2 or 3.
  constexpr int translations() const noexcept {
    return kind_ == Kind::plane || kind_ == Kind::planar_pose ? 2 : 3;
  }
  /// Axes about which it turns: 0, 1 or 3.
  constexpr int rotations() const noexcept {
    if (kind_ == Kind::planar_pose) return 1;
    return kind_ == Kind::spatial_pose ? 3 : 0;
  }
  /// Entries of a stored configuration.
  constexpr int stored() const noexcept { return kind_ == Kind::spatial_pose ? 7 : dimension(); }

  /// The configuration in which E is the base frame.
  Configuration origin() const noexcept;
  /// Whether `x` is one: of the right size, finite, and its quaternion of unit length to 1e-6.
  bool contains(const Configuration& x) const noexcept;

  /// x (+) xi. The origin where the sizes are wrong.
  Configuration plus(const Configuration& x, const PlatformVector& xi) const noexcept;
  /// a (-) b: the xi, shortest way round, with b (+) xi = a. Zero where the sizes are wrong.
  PlatformVector difference(const Configuration& a, const Configuration& b) const noexcept;

  /// Angle by which the platform is turned against the base frame, without sign [rad]; 0 where it cannot
  /// turn.
  double rotation_angle(const Configuration& x) const noexcept;

  friend constexpr bool operator==(ConfigurationSpace, ConfigurationSpace) = default;

 private:
  Kind kind_;
};

}  // namespace flinch
