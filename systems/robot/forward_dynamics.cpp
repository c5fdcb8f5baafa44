#include "systems/robot/forward_dynamics.h"

#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

/// M^-1 wrench, where that can be.
std::optional<PlatformVector> accelerated(PlatformMatrix M, PlatformVector wrench) noexcept {
  const Eigen::LLT<Eigen::Ref<PlatformMatrix>> cholesky(M);
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  cholesky.solveInPlace(wrench);
  if (!wrench.allFinite()) return std::nullopt;
  return wrench;
}

}  // namespace

std::optional<PlatformVector> forward_dynamics(const Kinematics& kinematics, const Dynamics& dynamics,
                                               const JointVector& drive_efforts,
                                               const PlatformVector& external_wrench) noexcept {
  const PlatformVector& v = kinematics.velocity;
  const bool usable = kinematics.reachable && dynamics.valid && dynamics.M_x.rows() == v.size() &&
                      drive_efforts.size() == drive_count(kinematics) && external_wrench.size() == v.size();
  if (!usable) return std::nullopt;
  PlatformVector wrench = external_wrench - dynamics.g_x - dynamics.F_fr_x;
  wrench.noalias() += kinematics.J_qa_x.transpose() * drive_efforts;
  wrench.noalias() -= dynamics.C_x * v;
  return accelerated(dynamics.M_x, wrench);
}

std::optional<PlatformVector> forward_dynamics(const Kinematics& kinematics, const MotionEquations& equations,
                                               const JointVector& drive_efforts,
                                               const PlatformVector& external_wrench) noexcept {
  const bool usable = kinematics.reachable && equations.valid &&
                      drive_efforts.size() == drive_count(kinematics) &&
                      external_wrench.size() == equations.h_x.size();
  if (!usable) return std::nullopt;
  PlatformVector wrench = external_wrench - equations.h_x;
  wrench.noalias() += kinematics.J_qa_x.transpose() * drive_efforts;
  return accelerated(equations.M_x, wrench);
}

double kinetic_energy(const Kinematics& kinematics, const Dynamics& dynamics) noexcept {
  if (!dynamics.valid) return 0.0;
  return 0.5 * kinematics.velocity.dot(dynamics.M_x * kinematics.velocity);
}

double kinetic_energy(const Kinematics& kinematics, const MotionEquations& equations) noexcept {
  if (!equations.valid) return 0.0;
  return 0.5 * kinematics.velocity.dot(equations.M_x * kinematics.velocity);
}

double friction_power(const Kinematics& kinematics, const Dynamics& dynamics) noexcept {
  if (!dynamics.valid) return 0.0;
  return kinematics.velocity.dot(dynamics.F_fr_x);
}

}  // namespace flinch
