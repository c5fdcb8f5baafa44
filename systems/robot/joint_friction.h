#pragma once

#include <cmath>
#include <string>

namespace flinch {

class Findings;

/// Friction viscous * rate + coulomb * sign(rate): a torque at a turning joint, a force at a sliding one.
struct JointFriction {
  double viscous = 0.0;  ///< [Nm s/rad] or [N s/m]
  double coulomb = 0.0;  ///< [Nm] or [N]
};

/// What `friction` takes at `rate` [Nm or N]; the step of Coulomb friction is rounded to
/// tanh(rate / friction_velocity).
inline double friction_effort(const JointFriction& friction, double rate, double friction_velocity) noexcept {
  const double viscous = friction.viscous * rate;
  return friction.coulomb == 0.0 ? viscous : viscous + friction.coulomb * std::tanh(rate / friction_velocity);
}

/// Dry friction of a drive as a model has it: effort * tanh(rate / velocity).
struct DryFriction {
  double effort = 0.0;    ///< Largest [Nm] or [N].
  double velocity = 0.0;  ///< Over which its step is rounded [rad/s] or [m/s]; not used without an effort.

  double at(double rate) const noexcept { return effort == 0.0 ? 0.0 : effort * std::tanh(rate / velocity); }
};

/// That friction `factor` times.
JointFriction scaled(const JointFriction& friction, double factor);

/// Adds where a part of a turning joint's friction is negative.
void find_friction_problems(const std::string& field, const JointFriction& friction, Findings& findings);

/// The same for a sliding joint.
void find_sliding_friction_problems(const std::string& field, const JointFriction& friction,
                                    Findings& findings);

}  // namespace flinch
