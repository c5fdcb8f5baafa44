#pragma once

#include <Eigen/Core>
#include <array>

#include "systems/safety/imu_errors.h"
#include "systems/safety/inertial_monitor.h"

namespace flinch {

/// How the platform moves at a tick, by encoders and model.
struct TickMotion {
  Time time{};
  Padded<max_stored> pose;
  Padded<max_dof> velocity;
  Padded<max_dof> step;          ///< of the pose since the tick before
  Padded<max_dof> acceleration;  ///< as the drives alone make it
};

/// Whether the inertial measurement unit can be believed, sample by sample.
///
/// What its accelerometer says beyond the model is either what the surroundings do or wrong. The encoders are
/// younger by the delay of the unit, so they have seen by then what the surroundings did: the mean second
/// difference of the pose beyond the model around the instant of the sample. A sample that claims more than
/// twice of that, and more than noise makes, is contradicted; so is one whose rate the encoders do not show,
/// unless it is they that jumped against the model. (Derived.)
///
/// A contradicted sample counts as none. Where half of the last samples are contradicted, or the unit
/// repeats itself, stands at its end or jumps, it is in doubt by name. It stays so until the operator
/// resets, or until it has told the truth for a second of motion, in which what was wrong with it would have
/// shown.
struct ImuMonitor {
  static constexpr std::size_t kept = 24;
  using Motions = Ring<TickMotion, kept>;
  using Errors = Ring<ImuError, ImuErrors::most>;
  struct Past {
    Motions::Past motion{};
    Errors::Past errors{};
  };

  Motions motion;                ///< in a row without a gap
  Errors errors;                 ///< likewise
  ImuReading before;             ///< the last reading
  int seen = 0, missing = 0;     ///< ticks with, and in a row without a valid reading
  std::array<int, 6> repeats{};  ///< of each axis, to the last bit
  Eigen::Matrix<double, 6, 1> largest = Eigen::Matrix<double, 6, 1>::Zero();  ///< of late, of each axis
  UsualBends usual;     ///< of what it says beyond what is expected
  bool blamed = false;  ///< for a rate that is not that of the encoders
  bool late = false;    ///< by its last samples
  int masked = 0;       ///< ticks that the unit is left out
  int honest = 0;       ///< samples in a row, in motion, since it is in doubt, that were as expected
  ImuFault doubt = ImuFault::none;
};

/// Takes in a tick; `learned` knows biases and noise of the unit at rest. Says in `found` what is in doubt.
void advance(ImuMonitor& watch, const ImuMonitor::Past& past, const InertialMonitor& learned,
             const AngleMonitor& angles, const PlausibilityTick& tick, Plausibility& found) noexcept;

/// The mean of second differences over the square of their interval that is the second derivative of the
/// parabola fitted to 2 h + 1 samples: weights of the differences -(h - 1) ... h - 1 around the middle,
/// proportional to (h^2 - i^2)((h + 1)^2 - i^2).
constexpr double parabola_weight(int h, int i) noexcept {
  const double square = static_cast<double>(i) * i, inner = static_cast<double>(h) * h;
  const double outer = (h + 1.0) * (h + 1.0);
  const double sum = 2.0 * h * (h + 1.0) * (2.0 * h + 1.0) * (4.0 * h * h + 4.0 * h - 3.0) / 15.0;
  return (inner - square) * (outer - square) / sum;
}

}  // namespace flinch
