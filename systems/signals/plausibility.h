#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "systems/signals/gate_fault.h"
#include "systems/signals/imu_fault.h"

namespace flinch {

/// The questions by which sensors and drives are asked whether they lie. Into none of them a contact can
/// enter.
enum class PlausibilityCheck : std::uint8_t {
  jump,           ///< an angle changes its rate more than any contact could make it
  isolated,       ///< and does so in one tick, with none before or after
  pair,           ///< or in two ticks there and back
  quiet_angle,    ///< the noise of an angle is gone
  gyroscope,      ///< encoders and gyroscope tell other rates
  accelerometer,  ///< encoders and accelerometer tell other changes of the velocity
  parity,         ///< active and passive encoders tell other poses
  tube,           ///< a current is none of those that were commanded lately
  quiet_current,  ///< the noise of a current is gone
  still,          ///< torques change, and nothing moves
  stop,           ///< a controlled stop does not take energy out
  brakes,         ///< what should be held moves
  status,         ///< the station says that the brakes are closed, against orders and motion
  response,       ///< a drive moves the robot as if its torque had another sign, or were none
};
inline constexpr std::size_t plausibility_checks = 14;

/// A set of questions, one bit each: bit i stands for the PlausibilityCheck with number i.
using CheckMask = std::uint32_t;

inline constexpr CheckMask all_checks = (CheckMask{1} << plausibility_checks) - 1;

constexpr CheckMask check_bit(PlausibilityCheck check) {
  return CheckMask{1} << static_cast<unsigned>(check);
}

/// What contradicts itself among the readings.
struct Plausibility {
  bool valid = false;
  FaultMask present = 0;      ///< faults that follow
  int drive = -1;             ///< of which drive, from 0, where one is known
  bool passive_lost = false;  ///< the passive encoders have been there and are no more
  bool imu_lost = false;      ///< likewise
  ImuFault imu_doubt = ImuFault::none;
  bool imu_left_out = false;  ///< nobody is told its present sample
  bool learning = false;      ///< noise is still being learned, before the first motion
  CheckMask askable = 0;      ///< what each of them needs is there: sensors, and what was learned of them
  /// By PlausibilityCheck: what was found over what is allowed; 0 where it could not be asked.
  std::array<double, plausibility_checks> ratio{};

  double& of(PlausibilityCheck check) { return ratio[static_cast<std::size_t>(check)]; }
  double of(PlausibilityCheck check) const { return ratio[static_cast<std::size_t>(check)]; }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("present", "", self.present);
    visit("drive", "", self.drive);
    visit("passive_lost", "", self.passive_lost);
    visit("imu_lost", "", self.imu_lost);
    visit("imu_doubt", "", self.imu_doubt);
    visit("imu_left_out", "", self.imu_left_out);
    visit("learning", "", self.learning);
    visit("askable", "", self.askable);
    visit("ratio", "", self.ratio);
  }
};

}  // namespace flinch
