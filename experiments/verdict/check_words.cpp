#include "experiments/verdict/check_words.h"

#include <fmt/core.h>

#include <array>

#include "systems/signals/gate_fault.h"

namespace flinch {
namespace {

using enum PlausibilityCheck;

constexpr const char* reaching = "commands that reach the robot whose readings are seen";

/// Questions that need the same.
struct Row {
  CheckMask checks;
  GateFault fault;  ///< that they may lead to
  const char* what;
  const char* needs;
};

constexpr std::array rows{
    Row{check_bit(jump) | check_bit(isolated) | check_bit(pair), GateFault::encoder_jump,
        "angles against what mass allows", reaching},
    Row{check_bit(quiet_angle), GateFault::encoder_frozen, "angles against their own noise",
        "angles of all drives with noise, read while the brakes hold the robot before its first motion"},
    Row{check_bit(parity), GateFault::encoders_implausible, "passive against active encoders",
        "passive encoders, read while the brakes hold the robot before its first motion"},
    Row{check_bit(gyroscope) | check_bit(accelerometer), GateFault::motion_contradicted,
        "encoders against the IMU",
        "an IMU that is believed, read while the brakes hold the robot before its first motion"},
    Row{check_bit(tube), GateFault::drive_not_following, "motor currents against commands",
        "motor currents, torque constants, and commands that reach the robot whose readings are seen"},
    Row{check_bit(quiet_current), GateFault::drive_not_following, "motor currents against their own noise",
        "currents of all drives with noise, read while the brakes hold the robot before its first motion"},
    Row{check_bit(still), GateFault::drives_without_effect, "torques against standing still", reaching},
    Row{check_bit(stop), GateFault::stop_ineffective, "a controlled stop against energy",
        "rates of the drives"},
    Row{check_bit(brakes), GateFault::brake_not_holding, "closed brakes against motion",
        "rates of the drives"},
    Row{check_bit(status), GateFault::status_contradicted, "the station's status against motion", reaching},
    Row{check_bit(response), GateFault::torque_contradicted, "torques against the motion that they make",
        reaching}};

constexpr CheckMask checks_of_rows() {
  CheckMask all = 0;
  for (const Row& row : rows) all |= row.checks;
  return all;
}
static_assert(checks_of_rows() == all_checks, "each check has a row");

}  // namespace

std::vector<std::string> checks_off(CheckMask askable, bool drives_checked) {
  std::vector<std::string> off;
  for (const Row& row : rows) {
    if ((row.checks & ~askable) == 0) continue;
    off.push_back(fmt::format("{} (fault {}): needs {}", row.what, static_cast<int>(row.fault), row.needs));
  }
  if (!drives_checked)
    off.push_back(
        fmt::format("drives before the first motion (fault {}): needs 'control.drive_check: true', {}",
                    static_cast<int>(GateFault::torque_contradicted), reaching));
  return off;
}

}  // namespace flinch
