#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace flinch {

/// How two surfaces push on each other. Whatever touches shares one stiffness: it is that of the pair.
struct ContactMaterial {
  double stiffness = 6000.0;        ///< k [N/m]
  double restitution = 0.5;         ///< e: speed after an impact over speed before; in (0, 1].
  double restitution_speed = 0.5;   ///< The impact speed at which the restitution is e [m/s].
  double friction = 0.0;            ///< Coulomb coefficient mu.
  double friction_velocity = 0.02;  ///< Sliding speed at which tanh smooths Coulomb friction [m/s].
};

/// All that is wrong with `material`, one sentence each that begins with `owner`.
std::vector<std::string> problems(const ContactMaterial& material, const std::string& owner);

/// Contact after Hunt and Crossley (1975) with a linear spring:
///   f = k d (1 + c d'), never negative,  d: depth of penetration.
/// The force begins at zero, so that it is continuous in time, and loses energy as d d', so that the
/// restitution falls with the impact speed. A mass that strikes a fixed surface at speed v and leaves it at
/// e v obeys, whatever the mass and k (from m v dv = -k d (1 + c v) dd around one impact),
///   a (1 + e) = ln((1 + a) / (1 - e a)),  a = c v.
class HuntCrossley {
 public:
  HuntCrossley() = default;
  /// The material's values must be positive (friction may be zero), its restitution at most 1.
  explicit HuntCrossley(const ContactMaterial& material);

  double stiffness() const { return stiffness_; }
  /// c [s/m]
  double dissipation() const { return dissipation_; }

  /// Normal force [N] at a depth [m] that grows at `depth_rate` [m/s]; zero without penetration.
  double normal_force(double depth, double depth_rate) const {
    if (depth <= 0.0) return 0.0;
    const double force = stiffness_ * depth * (1.0 + dissipation_ * depth_rate);
    return force > 0.0 ? force : 0.0;
  }

  /// Force [N] on a surface that slides with `velocity` [m/s], which is square to the normal: against it.
  /// Coulomb's law, smoothed: -mu f tanh(|v| / v_s) v / |v|.
  Eigen::Vector3d friction_force(double normal_force, const Eigen::Vector3d& velocity) const;

  /// c of a material with restitution `e` at the impact speed `v` [m/s].
  static double dissipation_for(double e, double v);
  /// The restitution at impact speed `v` [m/s].
  double restitution_at(double v) const;

 private:
  double stiffness_ = 0.0;
  double dissipation_ = 0.0;
  double friction_ = 0.0;
  double friction_velocity_ = 1.0;
};

}  // namespace flinch
