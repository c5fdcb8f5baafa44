#include "identification/imu_pose_calibration.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "identification/encoder_warnings.h"
#include "identification/imu_pose_fit.h"
#include "identification/imu_warnings.h"
#include "identification/stamp_spread_fit.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr double least_acceleration = 2.0;      // [m/s^2]
constexpr double least_angular_velocity = 0.3;  // [rad/s]
constexpr double poor = 0.15;                   // NRMSE after the fit: the axes or units are others

/// How well a modelled signal follows the measured one.
struct Agreement {
  double nrmse = 0.0;  ///< root mean square of the error over the range of the signal
  double snr = 0.0;    ///< signal over error [dB]
};

/// Of the translational accelerations, those of the components that move. [RAL25] V-B
Agreement agreement(const ImuResiduals& left) {
  double error = 0.0, signal = 0.0, range = 0.0;
  for (Eigen::Index c = 0; c < 3; ++c) {
    const Eigen::VectorXd measured = left.measured_accelerometer.col(c);
    const double span = measured.maxCoeff() - measured.minCoeff();
    range = std::max(range, span);
    error += left.accelerometer.col(c).squaredNorm();
    signal += (measured.array() - measured.mean()).square().sum();
  }
  const double n = static_cast<double>(left.accelerometer.rows());
  return {range > 0.0 ? std::sqrt(error / (3.0 * n)) / range : 0.0, 10.0 * std::log10(signal / error)};
}

/// The root of the mean of (10): gyroscope and accelerometer over their largest values.
double normalised_residual(const ImuResiduals& left) {
  const double w = left.measured_gyroscope.rowwise().norm().maxCoeff();
  const double a = left.measured_accelerometer.rowwise().norm().maxCoeff();
  const double n = static_cast<double>(left.gyroscope.rows());
  double sum = 0.0;
  if (w > 0.0) sum += left.gyroscope.squaredNorm() / (w * w);
  if (a > 0.0) sum += left.accelerometer.squaredNorm() / (a * a);
  return std::sqrt(sum / n);
}

std::vector<ImuStretch> stretches_of(const ParallelRobot& robot, const std::vector<ImuRecording>& recordings,
                                     std::vector<std::string>& warnings) {
  std::vector<ImuStretch> all;
  std::vector<std::string> problems;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    std::vector<std::string> own;
    try {
      for (ImuStretch& stretch : imu_stretches(*recordings[r].recording, robot, static_cast<int>(r), own))
        all.push_back(std::move(stretch));
    } catch (const SetupError& error) {
      for (const std::string& problem : error.problems())
        problems.push_back(recordings[r].source.file + ": " + problem);
    }
    for (const std::string& warning : own) warnings.push_back(recordings[r].source.file + ": " + warning);
  }
  throw_if_any(std::move(problems));
  return all;
}

double largest(const std::vector<ImuStretch>& stretches, const auto& signal) {
  double most = 0.0;
  for (const ImuStretch& stretch : stretches) most = std::max(most, signal(stretch));
  return most;
}

/// What the motion does not excite, and so nobody can tell.
void check_excitation(const std::vector<ImuStretch>& stretches) {
  const double turning = largest(stretches, [](const ImuStretch& stretch) {
    return stretch.angular_velocity.rowwise().norm().maxCoeff();
  });
  const double moving = largest(stretches, [](const ImuStretch& stretch) {
    return (stretch.specific_force.rowwise() - stretch.specific_force.colwise().mean())
        .rowwise()
        .norm()
        .maxCoeff();
  });
  if (moving < least_acceleration && turning < least_angular_velocity) {
    throw SetupError(
        fmt::format("the platform hardly moves: at most {:.2g} m/s^2 and {:.2g} rad/s; record a fast motion "
                    "with rotation, "
                    "such as calibration_rectangle.yaml",
                    moving, turning));
  }
}

class Told {
 public:
  Told(const ImuPoseFit& fit, const FitUncertainty& sure, CalibrationResult& result)
      : sure_(sure), result_(result) {
    const auto n = sure.covariance.rows();
    map_.setIdentity(n, n);
    // Angles follow from the rotation vector by differences.
    constexpr double h = 1e-6;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
      map_.block<3, 1>(0, i) =
          (mount_angles(turned(fit.pose.R_ES, step)) - mount_angles(turned(fit.pose.R_ES, -step))) /
          (2.0 * h);
    }
    covariance_ = map_ * sure.covariance * map_.transpose();
  }

  void add(const std::string& name, double value, Eigen::Index column, const char* unit,
           std::optional<double> before, const std::string& belongs_to, double more_deviation = 0.0) {
    const bool identifiable = sure_.identifiable[static_cast<std::size_t>(column)];
    const double deviation = std::hypot(std::sqrt(covariance_(column, column)), more_deviation);
    result_.parameters.push_back({.name = name,
                                  .value = identifiable || !before ? value : *before,
                                  .deviation = identifiable ? std::optional(deviation) : std::nullopt,
                                  .unit = unit,
                                  .identifiable = identifiable,
                                  .before = before,
                                  .belongs_to = belongs_to});
    columns_.push_back(column);
  }

  void finish() {
    const auto n = static_cast<Eigen::Index>(columns_.size());
    result_.covariance.resize(n, n);
    const Eigen::MatrixXd influence = map_ * sure_.influence;
    result_.influence.resize(n, influence.cols());
    for (Eigen::Index a = 0; a < n; ++a) {
      result_.influence.row(a) = influence.row(columns_[static_cast<std::size_t>(a)]);
      for (Eigen::Index b = 0; b < n; ++b)
        result_.covariance(a, b) =
            covariance_(columns_[static_cast<std::size_t>(a)], columns_[static_cast<std::size_t>(b)]);
    }
  }

 private:
  const FitUncertainty& sure_;
  CalibrationResult& result_;
  Eigen::MatrixXd map_, covariance_;
  std::vector<Eigen::Index> columns_;
};

void add_parameters(const ImuPoseFit& fit, const FitUncertainty& sure, const ImuMount& believed,
                    double period, double stamped_age, CalibrationResult& result) {
  Told told(fit, sure, result);
  const ImuPose& pose = fit.pose;
  const Eigen::Vector3d angles = mount_angles(pose.R_ES);
  for (int i = 0; i < 3; ++i) {
    told.add(fmt::format("control.imu_mount.position_m[{}]", i), pose.position[i], 3 + i, "m",
             believed.position_in_platform[i], "scenario");
  }
  for (int i = 0; i < 3; ++i) {
    told.add(fmt::format("control.imu_mount.angles_rad[{}]", i), angles[i], i, "rad", believed.angles[i],
             "scenario");
  }
  for (int i = 0; i < 3; ++i)
    told.add(fmt::format("gyroscope_bias[{}]", i), pose.gyroscope_bias[i], 6 + i, "rad/s", {}, "");
  for (int i = 0; i < 3; ++i)
    told.add(fmt::format("accelerometer_bias[{}]", i), pose.accelerometer_bias[i], 9 + i, "m/s^2", {}, "");
  // A reading came at any time within the period before the tick that first saw it.
  told.add("delay", pose.delay - 0.5 * period, 12, "s", {}, "", period / std::sqrt(12.0));
  told.add("stamp_error", pose.delay - stamped_age, 12, "s", {}, "");
  told.finish();
}

/// Not of the fit, and independent of it.
void add_stamp_spread(const std::optional<StampSpread>& spread, CalibrationResult& result) {
  result.parameters.push_back({.name = "control.imu_stamps.spread",
                               .value = spread ? spread->width : 0.0,
                               .deviation = spread ? std::optional(spread->deviation) : std::nullopt,
                               .unit = "s",
                               .identifiable = spread.has_value(),
                               .belongs_to = "scenario"});
  const Eigen::Index n = result.covariance.rows();
  result.covariance.conservativeResizeLike(Eigen::MatrixXd::Zero(n + 1, n + 1));
  result.influence.conservativeResizeLike(Eigen::MatrixXd::Zero(n + 1, result.influence.cols()));
  if (spread) result.covariance(n, n) = spread->deviation * spread->deviation;
}

void add_plots(const ImuResiduals& before, const ImuResiduals& after, CalibrationResult& result) {
  static constexpr const char* axes[] = {"x", "y", "z"};
  const auto add = [&](const char* sensor, const char* unit, const Eigen::MatrixXd& old_residuals,
                       const Eigen::MatrixXd& residuals) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      const Eigen::VectorXd old_column = old_residuals.col(c), column = residuals.col(c);
      result.plots.push_back({.title = fmt::format("{} {}", sensor, axes[c]),
                              .x_name = "time",
                              .x_unit = "s",
                              .y_name = "residual",
                              .y_unit = unit,
                              .x = after.time,
                              .before = {old_column.begin(), old_column.end()},
                              .after = {column.begin(), column.end()}});
    }
  };
  add("accelerometer", "m/s^2", before.accelerometer, after.accelerometer);
  add("gyroscope", "rad/s", before.gyroscope, after.gyroscope);
}

void tell_agreement(const ImuResiduals& before, const ImuResiduals& after, CalibrationResult& result) {
  const Agreement old = agreement(before);
  const Agreement now = agreement(after);
  result.notes.push_back(fmt::format(
      "translational acceleration: NRMSE {:.4f} before, {:.4f} after; SNR {:.1f} dB before, {:.1f} dB "
      "after",
      old.nrmse, now.nrmse, old.snr, now.snr));
  if (now.nrmse > poor) {
    result.warnings.push_back(fmt::format(
        "what is left is {:.0f} % of the range of the acceleration: axes of the IMU are swapped, its "
        "unit is another, or it is not on the platform",
        100.0 * now.nrmse));
  }
}

}  // namespace

CalibrationResult calibrate_imu_pose(const ParallelRobot& robot, const ImuMount& believed,
                                     const std::vector<ImuRecording>& recordings) {
  CalibrationResult result;
  result.kind = "imu-pose";
  result.residual_unit = "1";
  for (const ImuRecording& recording : recordings) result.recordings.push_back(recording.source);
  const std::vector<ImuStretch> stretches = stretches_of(robot, recordings, result.warnings);
  check_excitation(stretches);

  ImuBelief belief;
  belief.mount = believed;
  const ImuPoseFit fit = fit_imu_pose(stretches, belief);
  const FitUncertainty sure = fit_uncertainty(fit.linear);
  result.rank = sure.rank;
  result.condition = sure.condition;
  double age = 0.0;
  for (const ImuStretch& stretch : stretches)
    age += stretch.stamped_age / static_cast<double>(stretches.size());
  add_parameters(fit, sure, believed, stretches.front().period, age, result);
  add_stamp_spread(fit_stamp_spread(stretches, fit.pose), result);

  ImuPose before;
  before.R_ES = Eigen::Quaterniond(Eigen::Matrix3d(platform_to_sensor(believed).transpose()));
  before.position = believed.position_in_platform;
  before.delay = age;
  const ImuResiduals old_residuals = imu_residuals(stretches, before);
  const ImuResiduals residuals = imu_residuals(stretches, fit.pose);
  result.residual_before = normalised_residual(old_residuals);
  result.residual_after = normalised_residual(residuals);
  tell_agreement(old_residuals, residuals, result);
  result.contradictions = warnings_about_imu(stretches, belief, fit);
  add_encoder_warnings(recordings, robot, result.contradictions);
  add_plots(old_residuals, residuals, result);
  if (!result.parameters[0].identifiable && !result.parameters[1].identifiable) {
    result.warnings.push_back(
        "the platform hardly turns, so the position of the IMU cannot be told; record a motion with "
        "rotation");
  }
  for (const CalibratedParameter& parameter : result.parameters) {
    if (parameter.identifiable) continue;
    result.notes.push_back(
        parameter.name +
        " cannot be told from this motion; it stays as it was believed: measure it, or take "
        "it from a drawing");
  }
  return result;
}

}  // namespace flinch
