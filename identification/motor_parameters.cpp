#include "identification/motor_parameters.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "identification/dominant_wave.h"
#include "identification/robust_mean.h"
#include "systems/robot/mechanism.h"

namespace flinch {
namespace {

constexpr double fewest_waves = 2.0;      // over the way; what is slower may be friction or gravity
constexpr double least_explained = 0.03;  // of the scatter, for a wave to be believed
constexpr double usual_share = 0.01;      // of the largest torque
constexpr double usual_delay = 0.3e-3;    // of a torque behind its current [s]
constexpr double turn = 2.0 * std::numbers::pi;
constexpr int iterations = 10;
constexpr Eigen::Index of_wave = 3;  // s, c and r

/// How the surplus depends on s, c and r: what motors add, their currents need not.
Eigen::MatrixXd columns_of(const DynamicsRows& rows, const CoggingWave& wave) {
  return along_the_way(rows, wave.drive, [&](double q) -> Eigen::RowVector3d {
    const double sine = std::sin(wave.rate * q), cosine = std::cos(wave.rate * q);
    return {-sine, -cosine, -q * (wave.sine * cosine - wave.cosine * sine)};
  });
}

/// What is left at a drive.
class LeftAtDrive {
 public:
  LeftAtDrive(const DynamicsRows& rows, const Eigen::VectorXd& left, int drive)
      : rows_(rows), left_(left), drive_(drive) {
    const Eigen::VectorXd own = of_drive(rows, left, drive);
    largest_ = 4.0 * robust_deviation({own.begin(), own.end()});
  }

  Wave dominant() const {
    std::vector<WaveSample> samples;
    for (Eigen::Index row = 0; row < left_.size(); ++row) {
      if (!counts(row)) continue;
      const auto at = static_cast<std::size_t>(row);
      const DrivePath& path = rows_.paths[rows_.path[at]];
      samples.push_back({.position = path.position(rows_.sample[at], drive_),
                         .left = left_[row],
                         .blur = path.blur(rows_.sample[at], drive_)});
    }
    return dominant_wave(samples, fewest_waves, least_explained);
  }

  /// The wave that starts at a rate, after Gauss and Newton; an offset is found with it.
  void refine(CoggingWave& wave) const {
    for (int iteration = 0; iteration < iterations; ++iteration) {
      const Eigen::MatrixXd columns = columns_of(rows_, wave);
      Eigen::Matrix4d H = Eigen::Matrix4d::Zero();
      Eigen::Vector4d b = Eigen::Vector4d::Zero();
      for (Eigen::Index row = 0; row < left_.size(); ++row) {
        if (!counts(row)) continue;
        const Eigen::Vector4d a(1.0, columns(row, 0), columns(row, 1), columns(row, 2));
        H += a * a.transpose();
        b += left_[row] * a;
      }
      if (iteration == 0) H(3, 3) = 1.0;  // nothing is known of s and c, so nothing tells the rate
      const Eigen::Vector4d x = H.ldlt().solve(b);
      wave.sine = x[1];
      wave.cosine = x[2];
      wave.rate = std::max(wave.least, wave.rate + std::clamp(x[3], -wave.deviation, wave.deviation));
    }
  }

 private:
  bool counts(Eigen::Index row) const {
    return rows_.drive[static_cast<std::size_t>(row)] == drive_ && std::abs(left_[row]) <= largest_;
  }

  const DynamicsRows& rows_;
  const Eigen::VectorXd& left_;
  int drive_;
  double largest_ = 0.0;
};

}  // namespace

std::vector<CoggingWave> find_cogging(const DynamicsRows& rows, const Eigen::VectorXd& left, int drives) {
  std::vector<CoggingWave> waves;
  for (int drive = 0; drive < drives; ++drive) {
    const LeftAtDrive at(rows, left, drive);
    const Wave found = at.dominant();
    if (found.rate == 0.0) continue;
    waves.push_back({drive, found.rate, found.deviation, found.least});
    at.refine(waves.back());
  }
  return waves;
}

Eigen::VectorXd without_cogging(const DynamicsRows& rows, const Cogging& believed) {
  Eigen::VectorXd surplus = rows.surplus;
  for (int drive = 0; drive < static_cast<int>(believed.sine.size()); ++drive) {
    const CoggingWave wave{.drive = drive, .rate = turn / believed.wavelength[drive]};
    surplus -=
        columns_of(rows, wave).leftCols(2) * Eigen::Vector2d(believed.sine[drive], believed.cosine[drive]);
  }
  return surplus;
}

MotorParameters::MotorParameters(const DynamicParameters& robot, std::vector<CoggingWave> waves,
                                 DriveKind kind, const DriveParameters& believed)
    : robot_(robot), waves_(std::move(waves)), kind_(kind), believed_(believed) {
  list_ = robot.list();
  for (Eigen::Index drive = 0; drive < believed.torque_constant.size(); ++drive) {
    list_.push_back({.name = "drives.torque_delay_s[" + std::to_string(drive) + "]",
                     .unit = "s",
                     .believed = believed.torque_delay.size() > 0 ? believed.torque_delay[drive] : 0.0,
                     .deviation = usual_delay,
                     .least = -20.0 * longest_torque_delay});  // what cannot be must be seen
  }
  const DynamicParameter part{.deviation = usual_share * believed.max_torque, .least = -believed.max_torque};
  for (const CoggingWave& wave : waves_) {
    list_.insert(list_.end(), {part, part});
    list_.push_back({.believed = wave.rate, .deviation = wave.deviation, .least = wave.least});
  }
}

DynamicsRows MotorParameters::rows(DynamicsRows of_robot) const {
  Eigen::Index column = first_of_waves();
  of_robot.regressor.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(list_.size()));
  of_robot.regressor.middleCols(first_delay(), column - first_delay()).setZero();
  for (Eigen::Index row = 0; row < of_robot.slope.size(); ++row)
    of_robot.regressor(row, first_delay() + of_robot.drive[static_cast<std::size_t>(row)]) =
        of_robot.slope[row];
  for (const CoggingWave& wave : waves_) {
    of_robot.regressor.middleCols(column, of_wave) = columns_of(of_robot, wave);
    column += of_wave;
  }
  return of_robot;
}

Eigen::VectorXd MotorParameters::of_robot(const Eigen::VectorXd& values) const {
  return values.head(static_cast<Eigen::Index>(robot_.list().size()));
}

std::shared_ptr<const ParallelRobot> MotorParameters::with(const Eigen::VectorXd& values) const {
  return robot_.with(of_robot(values));
}

std::vector<Eigen::MatrixXd> MotorParameters::must_be_definite(const Eigen::VectorXd& values) const {
  return robot_.must_be_definite(of_robot(values));
}

// What was believed and is not found any more is taken back.
Cogging MotorParameters::cogging(const Eigen::VectorXd& values) const {
  if (waves_.empty() && believed_.cogging.is_none()) return {};
  const JointVector none = JointVector::Zero(believed_.torque_constant.size());
  const JointVector any = JointVector::Ones(none.size());
  Cogging now{believed_.cogging.is_none() ? any : believed_.cogging.wavelength, none, none};
  Eigen::Index of = first_of_waves();
  for (const CoggingWave& wave : waves_) {
    now.sine[wave.drive] = values[of];
    now.cosine[wave.drive] = values[of + 1];
    now.wavelength[wave.drive] = turn / values[of + 2];
    of += of_wave;
  }
  return now;
}

void MotorParameters::add(const Cogging& cogging, std::vector<FileValue>& in_file) const {
  const bool turns = kind_ == DriveKind::revolute;
  const std::string length = turns ? "rad" : "m", effort = turns ? "Nm" : "N";
  const auto add_list = [&](const std::string& key, const std::string& unit, const JointVector& of_drives) {
    for (Eigen::Index i = 0; i < of_drives.size(); ++i) {
      in_file.push_back({.name = "drives.cogging_" + key + "_" + unit + "[" + std::to_string(i) + "]",
                         .unit = unit,
                         .value = of_drives[i],
                         .mainly = {}});
    }
  };
  add_list("wavelength", length, cogging.wavelength);
  add_list("sine", effort, cogging.sine);
  add_list("cosine", effort, cogging.cosine);
}

std::vector<FileValue> MotorParameters::but_for_cogging(const Eigen::VectorXd& values) const {
  std::vector<FileValue> in_file = robot_.in_file(of_robot(values));
  for (std::ptrdiff_t j = first_delay(); j < first_of_waves(); ++j) {
    const DynamicParameter& delay = list_[static_cast<std::size_t>(j)];
    in_file.push_back(
        {.name = delay.name, .unit = delay.unit, .value = values[j], .mainly = static_cast<int>(j)});
  }
  return in_file;
}

std::vector<FileValue> MotorParameters::in_file(const Eigen::VectorXd& values) const {
  std::vector<FileValue> in_file = but_for_cogging(values);
  add(cogging(values), in_file);
  return in_file;
}

std::vector<int> MotorParameters::stilled() const {
  std::vector<int> drives;
  const Cogging& before = believed_.cogging;
  for (int drive = 0; drive < static_cast<int>(before.sine.size()); ++drive) {
    const bool cogs = std::any_of(waves_.begin(), waves_.end(),
                                  [&](const CoggingWave& wave) { return wave.drive == drive; });
    if (!cogs && std::hypot(before.sine[drive], before.cosine[drive]) > 0.0) drives.push_back(drive);
  }
  return drives;
}

std::vector<FileValue> MotorParameters::believed_in_file() const {
  std::vector<FileValue> in_file = but_for_cogging(believed());
  add(believed_.cogging, in_file);
  return in_file;
}

}  // namespace flinch
