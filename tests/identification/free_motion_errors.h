#pragma once

#include <cstdint>

#include "tests/identification/calibrated_robot.h"

namespace flinch::test {

/// As calibration_excitation.yaml and calibration_motion.yaml say it: a robot drawn anew, whose motors cog.
constexpr const char* excitation_realism =
    "plant: {realism: {like: bench, leg_inertia: 0.1, platform_inertia: 0.1, torque_constant: 0}}";
/// Parameters that are off, and nothing else of a real robot: what is left is noise.
constexpr const char* only_parameters =
    "plant: {realism: {friction: 0.2, leg_inertia: 0.1, platform_inertia: 0.1}}";

/// What the observer takes for a contact in a motion that nothing touches and no calibration has used, at
/// most, before and after the dynamics were calibrated.
struct FreeMotionErrors {
  double before = 0.0, after = 0.0;  ///< [N]
};

/// Of a planar robot drawn from a seed with this realism in all scenarios; its torque constants are known.
inline FreeMotionErrors free_motion_errors(std::uint64_t seed, const char* realism) {
  const CalibratedRobot::Replacements in_excitation = {{excitation_realism, realism}};
  const CalibratedRobot::Replacements in_motion = {
      {excitation_realism, realism},
      {"  drive_torque: {torque_constant_Nm_per_A: [6.1, 6.1, 6.1]}\n", ""},
      {"duration_s: 36", "duration_s: 10"}};
  CalibratedRobot robot(seed);
  FreeMotionErrors errors;
  errors.before = robot.judged("calibration_motion.yaml", in_motion).max_observer_error_force;
  robot.dynamics("calibration_excitation.yaml", in_excitation);
  errors.after = robot.judged("calibration_motion.yaml", in_motion).max_observer_error_force;
  return errors;
}

}  // namespace flinch::test
