#include "plant/bench_settings.h"

#include "plant/setting_problems.h"

namespace flinch {
namespace {

void check(const ContactMaterial& material, const std::string& owner, std::vector<std::string>& found) {
  SettingProblems problems(owner);
  problems.require_positive("stiffness", material.stiffness);
  problems.require_positive("restitution", material.restitution);
  problems.require_at_most(1.0, "restitution", material.restitution);
  problems.require_positive("restitution_speed", material.restitution_speed);
  problems.require_not_negative("friction", material.friction);
  problems.require_positive("friction_velocity", material.friction_velocity);
  problems.append_to(found);
}

void check(const Pylon& pylon, std::vector<std::string>& found) {
  SettingProblems problems("pylon.");
  problems.require_positive("radius", pylon.radius);
  if (pylon.mounting == Pylon::Mounting::compliant) {
    problems.require_positive("mass", pylon.mass);
    problems.require_positive("mount_stiffness", pylon.mount_stiffness);
    problems.require_not_negative("mount_damping", pylon.mount_damping);
  }
  problems.append_to(found);
  check(pylon.material, "pylon.material.", found);
}

}  // namespace

std::vector<std::string> problems(const BenchSettings& settings) {
  std::vector<std::string> found;
  if (settings.pylon) check(*settings.pylon, found);
  if (settings.link_material) check(*settings.link_material, "link_material.", found);
  SettingProblems brake("brake.");
  brake.require_not_negative("torque", settings.brake.torque);
  brake.require_positive("velocity", settings.brake.velocity);
  brake.append_to(found);
  return found;
}

}  // namespace flinch
