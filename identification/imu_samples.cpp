#include "identification/imu_samples.h"

#include <algorithm>
#include <cmath>

#include "identification/clipped.h"
#include "identification/encoder_motion.h"
#include "identification/spikes.h"
#include "identification/zero_phase.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"
#include "systems/robot/spatial_motion.h"
#include "systems/signals/imu_reading.h"

namespace flinch {
namespace {

constexpr double motion_cutoff = 150.0;    // products of what is low-passed are low-passed again below [Hz]
constexpr double cutoff_frequency = 40.0;  // [Hz]
constexpr double slowest_rate = 2.2 * cutoff_frequency;  // of readings [Hz]
constexpr Time shortest = 1s;

/// What the platform's own axes see of the motion.
void add_motion(const Recording& recording, const ParallelRobot& robot, const ValidStretch& stretch,
                ImuStretch& out) {
  const EncoderMotion motion = encoder_motion(recording, robot, stretch, motion_cutoff);
  const auto n = static_cast<Eigen::Index>(stretch.count);
  out.angular_velocity.resize(n, 3);
  out.angular_acceleration.resize(n, 3);
  out.specific_force.resize(n, 3);
  for (Eigen::Index k = 0; k < n; ++k) {
    const SpatialMotion now =
        spatial_motion(robot.space(), motion.pose[static_cast<std::size_t>(k)],
                       motion.velocity.row(k).transpose(), motion.acceleration.row(k).transpose());
    const Eigen::Matrix3d R_t = now.axes.transpose();
    out.angular_velocity.row(k) = (R_t * now.angular_velocity).transpose();
    out.angular_acceleration.row(k) = (R_t * now.angular_acceleration).transpose();
    out.specific_force.row(k) = (R_t * (now.acceleration - robot.gravity())).transpose();
  }
  for (Eigen::MatrixXd* signal : {&out.angular_velocity, &out.angular_acceleration, &out.specific_force})
    *signal = zero_phase(*signal, cutoff_frequency, out.period);
}

/// Readings by the tick at which they arrived; where there is no new one the one before stands.
void add_readings(const Recording& recording, const ValidStretch& stretch, ImuStretch& out) {
  const auto imu = read<ImuReading>(recording, "imu");
  const auto n = static_cast<Eigen::Index>(stretch.count);
  out.gyroscope.setZero(n, 3);
  out.accelerometer.setZero(n, 3);
  out.usable.assign(stretch.count, 0);
  double ages = 0.0, fresh = 0.0;
  Time last = Time(-1);
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t sample = stretch.first + static_cast<std::size_t>(k);
    const ImuReading reading = imu[sample];
    const bool good =
        reading.valid && reading.angular_velocity.allFinite() && reading.specific_force.allFinite();
    if (good && reading.acquired != last) {
      out.usable[static_cast<std::size_t>(k)] = 1;
      out.gyroscope.row(k) = reading.angular_velocity.transpose();
      out.accelerometer.row(k) = reading.specific_force.transpose();
      out.rates.push_back({to_seconds(reading.acquired), reading.angular_velocity});
      ages += to_seconds(Time(recording.time_ns[sample]) - reading.acquired);
      fresh += 1.0;
      last = reading.acquired;
    } else if (k > 0) {
      out.gyroscope.row(k) = out.gyroscope.row(k - 1);
      out.accelerometer.row(k) = out.accelerometer.row(k - 1);
    }
  }
  out.stamped_age = fresh > 0.0 ? ages / fresh : 0.0;
}

}  // namespace

std::vector<ImuStretch> imu_stretches(const Recording& recording, const ParallelRobot& robot, int number,
                                      std::vector<std::string>& warnings) {
  if (recording.find("imu") == nullptr) throw SetupError("there is no signal 'imu'");
  require_rate(recording.period, slowest_rate, "a fit of the pose of an IMU");
  std::vector<ImuStretch> stretches;
  std::size_t rows = 0, missing = 0, clipped = 0, spikes = 0;
  for (const ValidStretch& stretch :
       valid_stretches(recording, robot, static_cast<std::size_t>(shortest / recording.period))) {
    ImuStretch& out = stretches.emplace_back();
    out.recording = number;
    out.start = to_seconds(Time(recording.time_ns[stretch.first]));
    out.period = to_seconds(recording.period);
    add_readings(recording, stretch, out);
    rows += stretch.count;
    missing += static_cast<std::size_t>(std::count(out.usable.begin(), out.usable.end(), 0));
    for (Eigen::Index c = 0; c < 3; ++c) {
      clipped += mark_clipped(out.gyroscope.col(c), out.usable);
      clipped += mark_clipped(out.accelerometer.col(c), out.usable);
    }
    // Nothing within the reach of the filter of a row that is not usable is usable either.
    widen_unusable(out.usable, static_cast<std::ptrdiff_t>(0.5 / (cutoff_frequency * out.period)));
    spikes += remove_spikes(out.gyroscope) + remove_spikes(out.accelerometer);
    out.gyroscope = zero_phase(out.gyroscope, cutoff_frequency, out.period);
    out.accelerometer = zero_phase(out.accelerometer, cutoff_frequency, out.period);
    add_motion(recording, robot, stretch, out);
  }
  if (rows == 0) throw SetupError("no second of it is recorded with valid encoders in the nominal motion");
  if (missing == rows) throw SetupError("the IMU has no valid reading; is it connected?");
  const double share = 100.0 * static_cast<double>(missing) / static_cast<double>(rows);
  if (share > 5.0) {
    warnings.push_back(std::to_string(static_cast<int>(share)) +
                       " % of the readings of the IMU are missing; check its connection");
  }
  if (static_cast<double>(spikes) > 0.02 * 6.0 * static_cast<double>(rows)) {
    warnings.push_back(std::to_string(100 * spikes / (6 * rows)) +
                       " % of the numbers of the IMU are spikes, which are smoothed; check cable and supply");
  }
  if (clipped > 0) {
    warnings.push_back("the IMU is saturated in " + std::to_string(clipped) +
                       " samples, which are left out; move less fast or choose a wider range");
  }
  return stretches;
}

}  // namespace flinch
