#pragma once

#include <Eigen/Core>
#include <array>

#include "systems/safety/angle_monitor.h"
#include "systems/safety/ring.h"

namespace flinch {

/// How the sensor's point of the platform moves, as the encoders tell it.
struct SensorPointMotion {
  Time time{};
  bool known = false;
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};             ///< in the base frame [m/s]
  Eigen::Vector3d turning{0.0, 0.0, 0.0};              ///< in the sensor's frame [rad/s]
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< R: from the sensor's to the base frame
};

/// Mean and spread of what a sensor with three axes says while nothing moves.
struct LearnedBias {
  int count = 0;
  Eigen::Vector3d sum{0.0, 0.0, 0.0};
  Eigen::Vector3d squares{0.0, 0.0, 0.0};
  Eigen::Vector3d mean{0.0, 0.0, 0.0};
  double deviation = 0.0;  ///< standard deviation of the axis with the most

  void add(const Eigen::Vector3d& value) noexcept;
  bool known() const noexcept { return count >= LearnedNoise::enough; }
};

/// Encoders against the inertial measurement unit: both see the same motion, whatever caused it. The unit's
/// samples are late; each is compared with what the encoders said of its instant, give or take a tick.
struct InertialMonitor {
  static constexpr std::size_t window = 16;  ///< samples over which velocities are compared, at most
  using Motions = Ring<SensorPointMotion, 32>;

  Motions motion;
  std::array<ImuReading, 4> waiting{};                 ///< samples of the unit, the latest last
  Time acquired = -24h;                                ///< of the last one that was compared
  std::array<Eigen::Vector3d, window> acceleration{};  ///< in the base frame, a ring [m/s^2]
  std::array<double, window> change{};                 ///< |a - a of the one before|, likewise
  std::array<Time, window> measured{};                 ///< when, likewise
  std::size_t accelerations = 0;                       ///< in a row without a gap
  std::array<Eigen::Vector3d, 4> turning{};            ///< differences of rates, a ring [rad/s]
  std::size_t turnings = 0;
  LearnedBias gyroscope{};
  LearnedBias accelerometer{};
  std::array<double, 2> outside{};  ///< how far velocities were apart, in their limit, at the two before
};

void advance(InertialMonitor& watch, const InertialMonitor::Motions::Past& past, const AngleMonitor& angles,
             const PlausibilityTick& tick, Plausibility& found) noexcept;

}  // namespace flinch
