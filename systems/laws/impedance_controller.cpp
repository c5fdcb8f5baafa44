#include "systems/laws/impedance_controller.h"

#include <string>
#include <utility>
#include <vector>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/contact_jacobian.h"
#include "systems/signals/pose_guidance.h"

namespace flinch {
namespace {

std::vector<std::string> problems(const ImpedanceSettings& settings, int dof) {
  const std::string entries = "must have " + std::to_string(dof) + " entries";
  Findings found("impedance: ");
  found.require(settings.stiffness.size() == dof, "stiffness " + entries);
  found.require(settings.stiffness.allFinite() && (settings.stiffness.array() >= 0).all(),
                "stiffness must be finite and not negative");
  found.require(settings.damping_ratio.size() == dof, "damping_ratio " + entries);
  found.require(settings.damping_ratio.allFinite() && (settings.damping_ratio.array() > 0).all(),
                "damping_ratio must be finite and positive");
  return found.take();
}

}  // namespace

ImpedanceSettings complete(ImpedanceSettings settings, const ConfigurationSpace& space) {
  if (settings.stiffness.size() == 0) {
    settings.stiffness = PlatformVector::Constant(space.dimension(), 85.0);
    settings.stiffness.head(space.translations()).setConstant(2000.0);
  }
  if (settings.damping_ratio.size() == 0) settings.damping_ratio.setOnes(space.dimension());
  return settings;
}

ImpedanceController::ImpedanceController(std::shared_ptr<const ParallelRobot> robot,
                                         const ImpedanceSettings& settings)
    : robot_(std::move(robot)), settings_(complete(settings, robot_->space())) {
  throw_if_any(problems(settings_, robot_->dof()));
  K_d_ = settings_.stiffness.asDiagonal();
}

bool ImpedanceController::can_follow(const PlatformReference& desired) const {
  const auto fits = [this](const PlatformVector& vector) { return vector.size() == robot_->dof(); };
  return desired.valid && robot_->space().contains(desired.pose) && fits(desired.velocity) &&
         fits(desired.acceleration);
}

void ImpedanceController::impede(const PlatformReference& desired, const Kinematics& at,
                                 const Dynamics& model, ImpedanceWrench& result) const {
  const PlatformVector zero = PlatformVector::Zero(robot_->dof());
  result = {.valid = false, .damping = DampingDesign::none, .error = zero, .wrench_in_base = zero};
  if (!can_follow(desired) || !at.valid || !model.valid) return;

  const PlatformVector& dx = at.velocity;
  const ImpedanceDamping damping = impedance_damping(model.M_x, K_d_, settings_.damping_ratio);
  result.damping = damping.design;
  const PoseGuidance guidance = guide(robot_->space(), desired, at.pose, dx);
  result.error = guidance.error;

  PlatformVector F_a = model.C_x * dx + model.g_x + model.M_x * guidance.acceleration +
                       spring_wrench(robot_->space(), guidance.error, K_d_ * guidance.error) +
                       damping.D * (guidance.velocity - dx);  // [SafePR] (7)
  if (settings_.compensate_friction) F_a += model.F_fr_x;
  result.valid = damping.design != DampingDesign::none && F_a.allFinite();
  result.wrench_in_base = result.valid ? F_a : zero;
}

void ImpedanceController::drive(Time now, const ImpedanceWrench& wanted, const Kinematics& at,
                                TorqueCommand& command) const {
  command = {.computed = now, .valid = false, .torque = JointVector::Zero(robot_->drives())};
  if (!wanted.valid) return;
  command.torque = drive_torques(at, wanted.wrench_in_base);
  command.valid = command.torque.allFinite();
}

}  // namespace flinch
