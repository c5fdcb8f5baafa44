#include "systems/laws/impedance_controller.h"

#include <string>
#include <utility>
#include <vector>

#include "systems/foundation/setup_error.h"
#include "systems/robot/contact_jacobian.h"

namespace flinch {
namespace {

std::vector<std::string> problems(const ImpedanceSettings& settings, int dof) {
  const std::string entries = "must have " + std::to_string(dof) + " entries";
  std::vector<std::string> found;
  const auto require = [&found](bool good, const std::string& what) {
    if (!good) found.push_back("impedance: " + what);
  };
  require(settings.stiffness.size() == dof, "stiffness " + entries);
  require(settings.stiffness.allFinite() && (settings.stiffness.array() >= 0).all(),
          "stiffness must be finite and not negative");
  require(settings.damping_ratio.size() == dof, "damping_ratio " + entries);
  require(settings.damping_ratio.allFinite() && (settings.damping_ratio.array() > 0).all(),
          "damping_ratio must be finite and positive");
  return found;
}

}  // namespace

ImpedanceSettings planar_impedance() {
  return {.stiffness = Eigen::Vector3d(2000.0, 2000.0, 85.0), .damping_ratio = Eigen::Vector3d::Ones()};
}

ImpedanceController::ImpedanceController(std::shared_ptr<const ParallelRobot> robot,
                                         const ImpedanceSettings& settings)
    : robot_(std::move(robot)), settings_(settings) {
  throw_if_any(problems(settings, robot_->dof()));
  K_d_ = settings.stiffness.asDiagonal();
}

bool ImpedanceController::can_follow(const PlatformReference& desired) const {
  const auto fits = [this](const PlatformVector& vector) { return vector.size() == robot_->dof(); };
  return desired.valid && fits(desired.pose) && fits(desired.velocity) && fits(desired.acceleration);
}

void ImpedanceController::impede(const PlatformReference& desired, const Kinematics& at,
                                 const Dynamics& model, ImpedanceWrench& result) const {
  const PlatformVector zero = PlatformVector::Zero(robot_->dof());
  result = {.valid = false, .damping = DampingDesign::none, .error = zero, .wrench_in_base = zero};
  if (!can_follow(desired) || !at.valid || !model.valid) return;

  const PlatformVector& dx = at.velocity;
  const ImpedanceDamping damping = impedance_damping(model.M_x, K_d_, settings_.damping_ratio);
  result.damping = damping.design;
  result.error = robot_->difference(desired.pose, at.pose);
  const PlatformVector de = desired.velocity - dx;

  PlatformVector F_a = model.C_x * dx + model.g_x + model.M_x * desired.acceleration + K_d_ * result.error +
                       damping.D * de;  // [SafePR] (7)
  if (settings_.compensate_friction) F_a += model.F_fr_x;
  result.valid = damping.design != DampingDesign::none && F_a.allFinite();
  result.wrench_in_base = result.valid ? F_a : zero;
}

void ImpedanceController::drive(Time now, const ImpedanceWrench& wanted, const Kinematics& at,
                                TorqueCommand& command) const {
  command = {.computed = now, .valid = false, .torque = JointVector::Zero(robot_->dof())};
  if (!wanted.valid) return;
  command.torque = drive_torques(at, wanted.wrench_in_base);
  command.valid = command.torque.allFinite();
}

}  // namespace flinch
