#pragma once

#include <Eigen/Core>
#include <array>

#include "systems/framework/never_allocates.h"
#include "systems/framework/random.h"
#include "systems/robot/link_contact.h"

namespace flinch {

inline constexpr int max_particles = 256;

struct LinkParticleSettings {
  int particles = 50;  ///< R, at most `max_particles`
  /// Sigma_mot of one step, [PAR]: of the fraction, of the force along the link and across it [N^2].
  double fraction_variance = 2.5e-6;
  double along_variance = 1.25e-3;
  double across_variance = 12.5;
  double torque_variance = 10.0;  ///< Sigma_meas, of each drive, [PAR] [Nm^2 or N^2]
  /// Root mean square of f_x / f_y: as far as friction lets a force lean. 0: forces across the link alone.
  double leaning = 0.15;
  /// Standard deviation of the velocity of what is touched, along the link [m/s]; see lean_by_friction().
  double object_speed = 0.2;

  bool lean() const { return leaning > 0.0; }
};

/// One place and force that may be: l along the link, and the force in the axes of its `LinkContactMap` [N].
struct LinkParticle {
  double fraction = 0.5;
  Eigen::Vector3d force{0.0, 0.0, 0.0};
};

/// What the particles say together: mean and covariance of (l, force across the link), and the mean force. In
/// space the force across counts in its mean direction.
struct LinkParticleEstimate {
  bool valid = false;
  double fraction = 0.5;
  Eigen::Vector3d force{0.0, 0.0, 0.0};  ///< in the axes of the link [N]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// A particle filter of a contact on a link, [SafePR] III-D, (19)-(22): particles wander by `Sigma_mot`, are
/// weighed by how well the drives feel what each would do, and drawn anew by their weights. The force across
/// the link has one entry in the plane and two in space. A value: it holds its random generator, and never
/// allocates.
///
/// How far a force leans along the link the drives may not tell at all, as in the plane; and what they do not
/// tell, drawing anew loses: after 50 steps all of 50 particles descend from a few. So each particle then
/// takes a lean that it has not inherited, from those that friction makes, and goes to where that explains
/// the same torques, if that is on the link: a step of Gibbs sampling (resample-move, Gilks and Berzuini,
/// J. R. Statist. Soc. B 63, 2001).
class LinkParticles {
 public:
  explicit LinkParticles(std::uint64_t seed = 0) : random_(seed) {}

  /// Takes new particles: about `start` where it is identifiable, else anywhere on the link, with the force
  /// that fits `drive_torque` there best.
  void begin(const LinkContactMap& link, const Kinematics& kinematics, const LinkPush& start,
             const JointVector& drive_torque, const LinkParticleSettings& settings) noexcept;

  /// Moves, weighs and resamples; the estimate is the weighted mean before the resampling. Where no particle
  /// explains the torques all count alike. Not valid, and without effect, before `begin` or with input that
  /// cannot be used.
  LinkParticleEstimate step(const LinkContactMap& link, const Kinematics& kinematics,
                            const JointVector& drive_torque, const LinkParticleSettings& settings) noexcept;

  int count() const { return count_; }
  const LinkParticle& operator[](int i) const { return particles_[static_cast<std::size_t>(i)]; }
  void clear() { count_ = 0; }
  /// Becomes as `other` is; copies no more than there are.
  void take(const LinkParticles& other) noexcept;

 private:
  struct TorqueMaps;
  void move(const LinkParticleSettings& settings, int directions) noexcept;
  void resample(const std::array<double, max_particles>& weights, double sum) noexcept;
  void lean_anew(const TorqueMaps& maps, const JointVector& drive_torque, const Lean& lean,
                 const LinkParticleSettings& settings) noexcept;
  LinkParticle drawn_about(const LinkPush& push) noexcept;

  RandomGenerator random_;
  int count_ = 0;
  std::array<LinkParticle, max_particles> particles_;
};

/// Particles lie in the object itself.
template <>
inline constexpr bool never_allocates<LinkParticles> = true;

}  // namespace flinch
