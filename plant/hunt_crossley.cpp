#include "plant/hunt_crossley.h"

#include <algorithm>
#include <cmath>

#include "systems/foundation/bisection.h"
#include "systems/foundation/findings.h"

namespace flinch {
namespace {

// ln((1 - e a) / (1 + a)) + a (1 + e): zero where a = c v and the restitution e belong together, positive for
// smaller and negative for larger values of either.
double impact_balance(double a, double e) { return std::log1p(-e * a) - std::log1p(a) + a * (1.0 + e); }

}  // namespace

std::vector<std::string> problems(const ContactMaterial& material, const std::string& owner) {
  Findings found(owner);
  found.positive("stiffness", material.stiffness, "N/m");
  found.positive("restitution", material.restitution);
  found.at_most(1.0, "restitution", material.restitution);
  found.positive("restitution_speed", material.restitution_speed, "m/s");
  found.not_negative("friction", material.friction);
  found.positive("friction_velocity", material.friction_velocity, "m/s");
  return found.take();
}

HuntCrossley::HuntCrossley(const ContactMaterial& material)
    : stiffness_(material.stiffness),
      dissipation_(dissipation_for(material.restitution, material.restitution_speed)),
      friction_(material.friction),
      friction_velocity_(material.friction_velocity) {}

Eigen::Vector3d HuntCrossley::friction_force(double normal_force, const Eigen::Vector3d& velocity) const {
  const double speed = friction_ == 0.0 ? 0.0 : velocity.norm();
  if (speed == 0.0) return Eigen::Vector3d::Zero();
  return -friction_ * normal_force * std::tanh(speed / friction_velocity_) / speed * velocity;
}

double HuntCrossley::dissipation_for(double e, double v) {
  if (e >= 1.0) return 0.0;
  const double leading_order = 1.5 * (1.0 - e * e) / (1.0 + e * e * e);
  return bisect([e](double a) { return impact_balance(a, e); }, 0.5 * leading_order, 1.0 / e) / v;
}

double HuntCrossley::restitution_at(double v) const {
  const double a = dissipation_ * v;
  if (a <= 0.0) return 1.0;
  return bisect([a](double e) { return impact_balance(a, e); }, 0.0, std::min(1.0, 1.0 / a));
}

}  // namespace flinch
