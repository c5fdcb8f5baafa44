#include "identification/dynamics_rows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identification/clipped.h"
#include "identification/encoder_motion.h"
#include "identification/motor_currents.h"
#include "identification/robust_mean.h"
#include "identification/spikes.h"
#include "identification/zero_phase.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"
#include "systems/robot/parameter_variants.h"
#include "systems/signals/joint_reading.h"

namespace flinch {
namespace {

constexpr double motion_cutoff = 100.0;                  // what is made of it is low-passed again below [Hz]
constexpr double cutoff_frequency = 25.0;                // [Hz]
constexpr double slowest_rate = 2.2 * cutoff_frequency;  // of readings [Hz]
constexpr double rows_period = 0.01;                     // [s]
constexpr double edge = 0.1;                             // [s]
constexpr double cluster_length = 0.5;                   // [s]
constexpr Time shortest = 1s;

/// Currents at the instants of the encoders. A reading is what acted until its tick, so that what acts at the
/// tick lies half of the time for which it is held behind it; `share`: of the way to the next reading.
Eigen::MatrixXd between_ticks(const Eigen::MatrixXd& current, double share) {
  Eigen::MatrixXd mean = current;
  const Eigen::Index n = current.rows();
  mean.topRows(n - 1) = (1.0 - share) * current.topRows(n - 1) + share * current.bottomRows(n - 1);
  return mean;
}

double share_held(const TorqueBelief& belief, Time period) {
  if (belief.held == Time{} || belief.held >= period) return 0.5;
  return 0.5 * to_seconds(belief.held) / to_seconds(period);
}

/// Of currents, at the same instants [A/s].
Eigen::MatrixXd slopes(const Eigen::MatrixXd& current, double period) {
  const Eigen::Index n = current.rows();
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(n, current.cols());
  slope.topRows(n - 1) = (current.bottomRows(n - 1) - current.topRows(n - 1)) / period;
  return slope;
}

/// What is left of white noise of deviation 1 after the filter.
double noise_gain(double period) {
  Eigen::MatrixXd impulse = Eigen::MatrixXd::Zero(2001, 1);
  impulse(1000, 0) = 1.0;
  return zero_phase(impulse, cutoff_frequency, period).norm();
}

/// Deviation of the white noise in a signal that is smooth otherwise.
double white_noise(const Eigen::VectorXd& x) {
  const Eigen::Index n = x.size();
  const Eigen::VectorXd second = x.tail(n - 2) - 2.0 * x.segment(1, n - 2) + x.head(n - 2);
  return robust_deviation({second.begin(), second.end()}) / std::sqrt(6.0);
}

/// Of the torque of the noisiest drive, behind the filter.
double torque_noise(const Eigen::MatrixXd& current, const TorqueBelief& belief, double period) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < current.cols(); ++i)
    largest = std::max(largest, belief.constant[i] * white_noise(current.col(i)));
  return largest * noise_gain(period) / std::sqrt(2.0);
}

/// For so many rows and parameters; what is there stays.
void resize(DynamicsRows& rows, Eigen::Index count, Eigen::Index parameters) {
  rows.regressor.conservativeResize(count, parameters);
  rows.surplus.conservativeResize(count);
  rows.torque.conservativeResize(count);
  rows.slope.conservativeResize(count);
}

}  // namespace

double DrivePath::speed(Eigen::Index sample, int drive) const {
  const Eigen::Index last = std::max<Eigen::Index>(sample - 1, 0);
  const Eigen::Index next = std::min<Eigen::Index>(sample + 1, position.rows() - 1);
  return (position(next, drive) - position(last, drive)) / (static_cast<double>(next - last) * period);
}

double DrivePath::blur(Eigen::Index sample, int drive) const {
  return std::abs(speed(sample, drive)) / (2.0 * std::numbers::pi * cutoff_frequency);
}

void DynamicsRows::append(const DynamicsRows& more) {
  const Eigen::Index n = surplus.size(), m = more.surplus.size();
  resize(*this, n + m, more.regressor.cols());
  regressor.bottomRows(m) = more.regressor;
  surplus.tail(m) = more.surplus;
  torque.tail(m) = more.torque;
  slope.tail(m) = more.slope;
  drive.insert(drive.end(), more.drive.begin(), more.drive.end());
  cluster.insert(cluster.end(), more.cluster.begin(), more.cluster.end());
  recording.insert(recording.end(), more.recording.begin(), more.recording.end());
  time.insert(time.end(), more.time.begin(), more.time.end());
  for (const std::size_t own : more.path) path.push_back(paths.size() + own);
  sample.insert(sample.end(), more.sample.begin(), more.sample.end());
  paths.insert(paths.end(), more.paths.begin(), more.paths.end());
  noise = std::max(noise, more.noise);
}

Eigen::VectorXd of_drive(const DynamicsRows& rows, const Eigen::VectorXd& numbers, int drive) {
  std::vector<double> own;
  for (Eigen::Index row = 0; row < numbers.size(); ++row) {
    if (rows.drive[static_cast<std::size_t>(row)] == drive) own.push_back(numbers[row]);
  }
  return Eigen::Map<Eigen::VectorXd>(own.data(), static_cast<Eigen::Index>(own.size()));
}

Eigen::MatrixXd along_the_way(const DynamicsRows& rows, int drive,
                              const std::function<Eigen::RowVector3d(double position)>& of) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows.surplus.size(), 3);
  for (std::size_t number = 0; number < rows.paths.size(); ++number) {
    const DrivePath& path = rows.paths[number];
    Eigen::MatrixXd there(path.position.rows(), 3);
    for (Eigen::Index k = 0; k < there.rows(); ++k) there.row(k) = of(path.position(k, drive));
    there = zero_phase(there, cutoff_frequency, path.period);
    for (std::size_t row = 0; row < rows.path.size(); ++row) {
      if (rows.drive[row] == drive && rows.path[row] == number)
        result.row(static_cast<Eigen::Index>(row)) = there.row(rows.sample[row]);
    }
  }
  return result;
}

namespace {

/// The rows of one stretch.
DynamicsRows rows_of(const Recording& recording, const ParallelRobot& robot,
                     const ParameterVariants& variants, const TorqueBelief& belief,
                     const ValidStretch& stretch, MotorCurrents currents, int number) {
  const double period = to_seconds(recording.period);
  const EncoderMotion motion = encoder_motion(recording, robot, stretch, motion_cutoff);
  const int drives = robot.drives();
  const auto n = static_cast<Eigen::Index>(stretch.count);
  const auto p = static_cast<Eigen::Index>(variants.size());
  DynamicsRows out;
  out.noise = torque_noise(currents.current, belief, period);
  const auto reach = static_cast<std::ptrdiff_t>(2.0 / (cutoff_frequency * period));  // of the filter
  for (std::vector<char>& usable : currents.usable) widen_unusable(usable, reach);
  Eigen::MatrixXd torque =
      between_ticks(currents.current, share_held(belief, recording.period)) * belief.constant.asDiagonal();
  Eigen::MatrixXd slope = slopes(currents.current, period) * belief.constant.asDiagonal();
  if (belief.delay.size() > 0) torque -= slope * belief.delay.asDiagonal();
  Eigen::MatrixXd surplus(n, drives), Y(n, drives * p);
  out.paths = {{Eigen::MatrixXd(n, drives), period}};
  const auto joints = read<JointReading>(recording, "joints");
  for (Eigen::Index k = 0; k < n; ++k) {
    Kinematics at;
    stretch.robot(robot).kinematics(motion.pose[static_cast<std::size_t>(k)],
                                    motion.velocity.row(k).transpose(), at);
    const PlatformVector acceleration = motion.acceleration.row(k).transpose();
    const JointVector base = model_effort(robot, at, acceleration);
    surplus.row(k) = torque.row(k) - base.transpose();
    Eigen::MatrixXd of_sample = variants.regressor(base, at, acceleration);
    out.paths[0].position.row(k) = joints[stretch.first + static_cast<std::size_t>(k)].active.transpose();
    Y.row(k) = Eigen::Map<Eigen::RowVectorXd>(of_sample.data(), of_sample.size());
  }
  torque = zero_phase(torque, cutoff_frequency, period);
  slope = zero_phase(slope, cutoff_frequency, period);
  surplus = zero_phase(surplus, cutoff_frequency, period);
  Y = zero_phase(Y, cutoff_frequency, period);

  const auto step = std::max<Eigen::Index>(1, std::lround(rows_period / period));
  const auto margin = static_cast<Eigen::Index>(edge / period);
  const Eigen::Index samples = std::max<Eigen::Index>(0, (n - 2 * margin + step - 1) / step);
  resize(out, samples * drives, p);
  Eigen::Index row = 0;
  for (Eigen::Index s = 0; s < samples; ++s) {
    const Eigen::Index k = margin + s * step;
    const double time = to_seconds(Time(recording.time_ns[stretch.first + static_cast<std::size_t>(k)]));
    for (int i = 0; i < drives; ++i) {
      if (currents.usable[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] == 0) continue;
      for (Eigen::Index j = 0; j < p; ++j) out.regressor(row, j) = Y(k, j * drives + i);
      out.surplus[row] = surplus(k, i);
      out.torque[row] = torque(k, i);
      out.slope[row] = slope(k, i);
      out.drive.push_back(i);
      out.cluster.push_back(100000 * number + static_cast<int>(time / cluster_length));
      out.recording.push_back(number);
      out.time.push_back(time);
      out.path.push_back(0);
      out.sample.push_back(k);
      ++row;
    }
  }
  resize(out, row, p);
  return out;
}

}  // namespace

DynamicsRows dynamics_rows(const Recording& recording, const ParallelRobot& robot,
                           const DynamicParameters& parameters, const TorqueBelief& belief, int number,
                           std::vector<std::string>& warnings) {
  require_rate(recording.period, slowest_rate, "a fit of dynamics");
  const ParameterVariants variants(parameters);
  DynamicsRows rows;
  MotorCurrents defects;
  std::size_t spikes = 0, samples = 0;
  for (const ValidStretch& stretch :
       valid_stretches(recording, robot, static_cast<std::size_t>(shortest / recording.period))) {
    MotorCurrents currents = motor_currents(recording, stretch, robot.drives());
    defects.count(currents);
    spikes += remove_spikes(currents.current);
    samples += stretch.count;
    rows.append(rows_of(recording, robot, variants, belief, stretch, std::move(currents), number));
  }
  if (samples == 0) {
    throw SetupError(
        "no second of it is recorded with valid encoders in the nominal motion; check their link, or record "
        "longer");
  }
  const std::vector<std::string> wrong = defects.warnings(samples);
  if (rows.surplus.size() == 0) throw SetupError(wrong);
  warnings.insert(warnings.end(), wrong.begin(), wrong.end());
  const std::size_t all = samples * static_cast<std::size_t>(robot.drives());
  if (static_cast<double>(spikes) > 0.02 * static_cast<double>(all)) {
    warnings.push_back(std::to_string(100 * spikes / all) +
                       " % of the motor currents are spikes, which are smoothed; check the amplifiers");
  }
  return rows;
}

}  // namespace flinch
