#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "systems/framework/time.h"
#include "systems/safety/ring.h"
#include "systems/signals/imu_fault.h"

namespace flinch {

/// What a sample of the inertial measurement unit says beyond what is expected of it; sensor axes.
struct ImuError {
  Time spacing{1ms};                                ///< since the sample before
  Eigen::Vector3d force{0.0, 0.0, 0.0};             ///< beyond what the model expects [m/s^2]
  Eigen::Vector3d turning{0.0, 0.0, 0.0};           ///< beyond what the encoders say [rad/s]
  Eigen::Vector3d expected_force{0.0, 0.0, 0.0};    ///< [m/s^2]
  Eigen::Vector3d expected_turning{0.0, 0.0, 0.0};  ///< [rad/s]
  Eigen::Vector3d force_slope{0.0, 0.0, 0.0};       ///< d/dt of what is expected [m/s^3]
  Eigen::Vector3d turning_slope{0.0, 0.0, 0.0};     ///< likewise [rad/s^2]
  Eigen::Vector3d rising{0.0, 0.0, 0.0};            ///< doubt about what the drives make of force [m/s^2]
  double stamp_spread = 0.0;                        ///< width of the range in which its stamp errs [s]
  Eigen::Vector3d force_unseen{0.0, 0.0, 0.0};      ///< what steps of the encoders do not show [m/s^2]
  Eigen::Vector3d turning_unseen{0.0, 0.0, 0.0};    ///< likewise [rad/s]
  bool contradicted = false;                        ///< nothing of the robot explains it
  bool jumps = false;                               ///< `jumped` was true of it
};

/// The latest samples in a row.
struct ImuErrors : Series<ImuError, 20> {
  static constexpr std::size_t most = 20;
  static constexpr int judged = 16;
  using Series::Series;

  int contradicted(int latest = judged) const noexcept;  ///< of the latest, at most `judged`
};

/// Standard deviations that errors of an honest unit have.
struct ImuSpread {
  double force = 0.0;    ///< [m/s^2]
  double turning = 0.0;  ///< [rad/s]
};

/// How much errors of late bend from sample to sample: means of squares of second differences, of force over
/// turning, each in its deviations at rest. White noise has 6 of it. Motors whose torque ripples shake the
/// platform faster than it is sampled, which no model tells; so what is usual is learned, slowly enough that
/// a unit that fails does not become usual before it is found.
struct UsualBends {
  Eigen::Matrix<double, 6, 1> squares = Eigen::Matrix<double, 6, 1>::Constant(6.0);

  /// Takes in the latest sample, a time after the one before.
  void follow(const ImuErrors& errors, const ImuSpread& rest) noexcept;
};

/// Whether the error has jumped to and fro at the sample of `age`, like noise that is several times what is
/// usual and that of `rest`: two second differences in a row of four deviations, beyond those of what is
/// expected, change their sign. A contact bends the error, but one way.
bool jumped(const ImuErrors& errors, std::size_t age, const ImuSpread& rest,
            const UsualBends& usual = {}) noexcept;

/// Whether five of the last twelve samples do.
bool jumps(const ImuErrors& errors) noexcept;

/// Standard deviations of what the encoders tell of the unit, by axes.
struct EncoderSpread {
  Eigen::Vector3d position{0.0, 0.0, 0.0};  ///< [m]
  Eigen::Vector3d angle{0.0, 0.0, 0.0};     ///< [rad]
};

/// By how much the unit is later than its stamps say.
struct Lateness {
  double time = 0.0;       ///< [s]
  double deviation = 0.0;  ///< of it, by noise [s]; 0: not known
  double explained = 0.0;  ///< share of all squares that it explains
};

/// The time by which the last `samples` are late. Summed up twice, what an accelerometer that is late by
/// tau says beyond the encoders is -tau times the velocity, but for a constant and a slope; what a gyroscope
/// says, summed up once, is -tau times its rate, but for a constant. No model is needed, so nothing that
/// moves the platform can be taken for it. By least squares, each axis weighed by its noise. (Derived.)
Lateness lateness(const ImuErrors& errors, std::size_t samples, const EncoderSpread& encoders,
                  const ImuSpread& unit) noexcept;

/// Whether the last 10 or 20 ms, of five samples at least, are surely late: by more than 0.7 ms, what stamps
/// may err and five deviations, which explains seven tenths of all squares.
bool is_late(const ImuErrors& errors, const EncoderSpread& encoders, const ImuSpread& unit,
             Time spacing = 1ms) noexcept;

/// What explains the contradicted ones best: a constant, a time by which the unit is late, or axes that are
/// turned; each fitted by least squares, and judged by its squares left plus ln(n) for each parameter (the
/// Bayesian information criterion). None that leaves more than half of the squares is an explanation; without
/// one the unit is noisy where three of its last twelve samples have jumped.
ImuFault explanation(const ImuErrors& errors, const ImuSpread& spread) noexcept;

}  // namespace flinch
