#include "identification/motor_parameters.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "identification/dominant_wave.h"
#include "identification/robust_mean.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/mechanism.h"

namespace flinch {
namespace {

constexpr double fewest_waves = 2.0;    // over the way; what is slower may be friction or gravity
constexpr double usual_share = 0.01;    // of the largest torque
constexpr double usual_delay = 0.3e-3;  // of a torque behind its current [s]
constexpr double turn = 2.0 * std::numbers::pi;
constexpr int iterations = 10;
constexpr double converged = 1e-3;   // of the deviation of a rate: by which it still changes
constexpr Eigen::Index of_wave = 3;  // s, c and r

/// How the surplus depends on s, c and r: what motors add, their currents need not.
Eigen::MatrixXd columns_of(const DynamicsRows& rows, const DriveWave& wave) {
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

  /// As `dominant_wave`.
  Wave dominant(double least) const {
    std::vector<WaveSample> samples;
    for (Eigen::Index row = 0; row < left_.size(); ++row) {
      if (!counts(row)) continue;
      const auto at = static_cast<std::size_t>(row);
      const DrivePath& path = rows_.paths[rows_.path[at]];
      samples.push_back({.position = path.position(rows_.sample[at], drive_),
                         .left = left_[row],
                         .blur = path.blur(rows_.sample[at], drive_)});
    }
    return dominant_wave(samples, fewest_waves, least);
  }

  /// The wave that starts at a rate, after Gauss and Newton; an offset is found with it.
  void refine(DriveWave& wave) const {
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
      if (iteration > 0 && std::abs(x[3]) < converged * wave.deviation) break;
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

/// What a wave adds to the surplus of rows [Nm or N].
Eigen::VectorXd surplus_of(const DynamicsRows& rows, const DriveWave& wave) {
  return columns_of(rows, wave).leftCols(2) * Eigen::Vector2d(wave.sine, wave.cosine);
}

/// By rate. One that is as fast as another is what that one could not explain, and ends the search.
std::vector<DriveWave> waves_of_drive(const DynamicsRows& rows, Eigen::VectorXd left, int drive,
                                      double least) {
  std::vector<DriveWave> waves;
  while (waves.size() < static_cast<std::size_t>(most_cogging_waves)) {
    const LeftAtDrive at(rows, left, drive);
    const Wave found = at.dominant(least);
    DriveWave wave{drive, found.rate, found.deviation, found.least};
    const bool is_known = std::any_of(waves.begin(), waves.end(), [&](const DriveWave& known) {
      return std::abs(known.rate - wave.rate) < wave.least;
    });
    if (found.rate == 0.0 || is_known) break;
    at.refine(wave);
    left -= surplus_of(rows, wave);
    waves.push_back(wave);
  }
  // Each was found among those that came later.
  for (int pass = 0; pass < 2 && waves.size() > 1; ++pass) {
    for (DriveWave& wave : waves) {
      left += surplus_of(rows, wave);
      LeftAtDrive(rows, left, drive).refine(wave);
      left -= surplus_of(rows, wave);
    }
  }
  std::sort(waves.begin(), waves.end(),
            [](const DriveWave& a, const DriveWave& b) { return a.rate < b.rate; });
  return waves;
}

/// By drive and rate, without those that have no size.
std::vector<DriveWave> drive_waves(const Cogging& cogging) {
  std::vector<DriveWave> waves;
  for (const CoggingWave& wave : cogging.waves) {
    for (int drive = 0; drive < static_cast<int>(wave.sine.size()); ++drive) {
      const DriveWave one{.drive = drive,
                          .rate = turn / wave.wavelength[drive],
                          .sine = wave.sine[drive],
                          .cosine = wave.cosine[drive]};
      if (std::hypot(one.sine, one.cosine) > 0.0) waves.push_back(one);
    }
  }
  return waves;
}

}  // namespace

std::vector<DriveWave> find_cogging(const DynamicsRows& rows, const Eigen::VectorXd& left, int drives,
                                    double least) {
  std::vector<DriveWave> waves;
  for (int drive = 0; drive < drives; ++drive) {
    const std::vector<DriveWave> own = waves_of_drive(rows, left, drive, least);
    waves.insert(waves.end(), own.begin(), own.end());
  }
  return waves;
}

Eigen::VectorXd without_cogging(const DynamicsRows& rows, const Cogging& believed) {
  Eigen::VectorXd surplus = rows.surplus;
  for (const DriveWave& wave : drive_waves(believed)) surplus -= surplus_of(rows, wave);
  return surplus;
}

MotorParameters::MotorParameters(const DynamicParameters& robot, std::vector<DriveWave> waves, DriveKind kind,
                                 const DriveParameters& believed)
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
  for (const DriveWave& wave : waves_) {
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
  for (const DriveWave& wave : waves_) {
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
  const JointVector none = JointVector::Zero(believed_.torque_constant.size());
  const JointVector any = JointVector::Ones(none.size());
  Cogging now = believed_.cogging;
  for (CoggingWave& wave : now.waves) wave.sine = wave.cosine = none;
  Eigen::Index of = first_of_waves();
  std::size_t of_drive = 0;
  for (std::size_t w = 0; w < waves_.size(); ++w, of += of_wave) {
    const int drive = waves_[w].drive;
    of_drive = w > 0 && waves_[w - 1].drive == drive ? of_drive + 1 : 0;
    if (now.waves.size() <= of_drive) now.waves.push_back({any, none, none});
    CoggingWave& wave = now.waves[of_drive];
    wave.sine[drive] = values[of];
    wave.cosine[drive] = values[of + 1];
    wave.wavelength[drive] = turn / values[of + 2];
  }
  return now;
}

void MotorParameters::add(const Cogging& cogging, std::vector<FileValue>& in_file) const {
  const bool turns = kind_ == DriveKind::revolute;
  const std::string length = turns ? "rad" : "m", effort = turns ? "Nm" : "N";
  const auto add_list = [&](const std::string& key, const std::string& unit, const JointVector& of_drives) {
    for (Eigen::Index i = 0; i < of_drives.size(); ++i) {
      in_file.push_back({.name = "drives." + key + "_" + unit + "[" + std::to_string(i) + "]",
                         .unit = unit,
                         .value = of_drives[i],
                         .mainly = {}});
    }
  };
  for (std::size_t w = 0; w < cogging.waves.size(); ++w) {
    const std::string key = cogging_key(static_cast<int>(w));
    add_list(key + "wavelength", length, cogging.waves[w].wavelength);
    add_list(key + "sine", effort, cogging.waves[w].sine);
    add_list(key + "cosine", effort, cogging.waves[w].cosine);
  }
}

std::vector<FileValue> MotorParameters::but_for_cogging(const Eigen::VectorXd& values) const {
  std::vector<FileValue> in_file = robot_.in_file(of_robot(values));
  for (std::ptrdiff_t j = first_delay(); j < first_of_waves(); ++j) {
    const DynamicParameter& delay = list_[static_cast<std::size_t>(j)];
    in_file.push_back(
        {.name = delay.name, .unit = delay.unit, .value = values[j], .mainly = {static_cast<int>(j)}});
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
  for (const DriveWave& before : drive_waves(believed_.cogging)) {
    const bool is_seen = std::any_of(waves_.begin(), waves_.end(), [&](const DriveWave& wave) {
      return wave.drive == before.drive && std::abs(wave.rate - before.rate) < wave.least;
    });
    const bool is_told = std::find(drives.begin(), drives.end(), before.drive) != drives.end();
    if (!is_seen && !is_told) drives.push_back(before.drive);
  }
  return drives;
}

std::vector<FileValue> MotorParameters::believed_in_file() const {
  std::vector<FileValue> in_file = but_for_cogging(believed());
  add(believed_.cogging, in_file);
  return in_file;
}

}  // namespace flinch
