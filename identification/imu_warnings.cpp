#include "identification/imu_warnings.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "identification/likely_scale.h"
#include "identification/swapped_axes.h"
#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

constexpr double least_turning = 0.1;       // deviation of what the encoders tell [rad/s]
constexpr double least_moving = 0.5;        // likewise [m/s^2]
constexpr double least_gravity = 5.0;       // in the plane of sight of the platform [m/s^2]
constexpr double removed_gravity = 0.25;    // of it: less is left
constexpr double largest_deviations = 5.0;  // of a belief

/// Rows that are usable, of all stretches one after the other.
struct Rows {
  Eigen::MatrixXd measured, expected;

  Eigen::RowVector3d measured_mean() const { return measured.colwise().mean(); }
  Eigen::RowVector3d expected_mean() const { return expected.colwise().mean(); }
  Eigen::MatrixXd measured_change() const { return measured.rowwise() - measured_mean(); }
  Eigen::MatrixXd expected_change() const { return expected.rowwise() - expected_mean(); }
  double expected_deviation() const { return deviation(expected_change()); }
  /// By how much the changes are larger than they should be, whatever the axes.
  double scale() const { return deviation(measured_change()) / deviation(expected_change()); }

 private:
  static double deviation(const Eigen::MatrixXd& change) {
    return std::sqrt(change.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(change.rows(), 1)));
  }
};

Rows rows_of(const std::vector<ImuStretch>& stretches, Eigen::MatrixXd ImuStretch::*measured,
             Eigen::MatrixXd ImuStretch::*expected) {
  Eigen::Index count = 0;
  for (const ImuStretch& stretch : stretches)
    count += std::count(stretch.usable.begin(), stretch.usable.end(), 1);
  Rows rows{Eigen::MatrixXd(count, 3), Eigen::MatrixXd(count, 3)};
  Eigen::Index next = 0;
  for (const ImuStretch& stretch : stretches) {
    for (std::size_t k = 0; k < stretch.usable.size(); ++k) {
      if (stretch.usable[k] == 0) continue;
      rows.measured.row(next) = (stretch.*measured).row(static_cast<Eigen::Index>(k));
      rows.expected.row(next++) = (stretch.*expected).row(static_cast<Eigen::Index>(k));
    }
  }
  return rows;
}

class Doubts {
 public:
  Doubts(const std::vector<ImuStretch>& stretches, const ImuBelief& belief, const ImuPoseFit& fit)
      : belief_(belief),
        fit_(fit),
        R_SE_(platform_to_sensor(belief.mount)),
        turning_(rows_of(stretches, &ImuStretch::gyroscope, &ImuStretch::angular_velocity)),
        force_(rows_of(stretches, &ImuStretch::accelerometer, &ImuStretch::specific_force)) {}

  std::vector<std::string> take() {
    if (force_.measured.rows() == 0) return {};
    const bool turns = turning_.expected_deviation() > least_turning;
    const bool moves = force_.expected_deviation() > least_moving;
    if (turns) doubt_scale("gyroscope", turning_.scale(), causes_of_gyroscopes());
    if (moves) doubt_scale("accelerometer", force_.scale(), causes_of_accelerometers());
    if (!all_.empty()) return all_;  // what follows would only repeat it
    if (force_.expected_mean().norm() > least_gravity) doubt_gravity(turns);
    if (all_.empty() && moves) doubt_axes();
    if (all_.empty()) doubt_values();
    return all_;
  }

 private:
  void doubt_scale(const char* sensor, double scale, std::span<const ScaleCause> causes) {
    const std::optional<std::string> cause = likely_cause(scale, causes);
    if (cause) {
      all_.push_back(
          fmt::format("the {} reads {} what the encoders tell: {}", sensor, factor_text(scale), *cause));
    } else if (scale > 2.0 || scale < 0.5) {
      all_.push_back(fmt::format("the {} reads {} what the encoders tell; check its unit and its range",
                                 sensor, factor_text(scale)));
    }
  }

  /// Where the accelerometer sees gravity, and where the encoders and what is believed of the mounting say.
  void doubt_gravity(bool turns) {
    const Eigen::Vector3d expected = R_SE_ * force_.expected_mean().transpose();
    const Eigen::Vector3d measured = force_.measured_mean().transpose();
    if (measured.norm() < removed_gravity * expected.norm()) {
      all_.push_back(fmt::format(
          "the accelerometer shows {:.2g} m/s^2 on average where gravity is {:.2g}: its driver has "
          "removed gravity; take the raw specific force",
          measured.norm(), expected.norm()));
      return;
    }
    const double across = expected.dot(measured) / (expected.norm() * measured.norm());
    const double together =
        turns
            ? (turning_.expected_change() * R_SE_.transpose()).cwiseProduct(turning_.measured_change()).sum()
            : 1.0;
    if (across < -0.8 && together > 0.0) {
      all_.emplace_back(
          "the accelerometer has the other sign: at rest it must show 9.81 m/s^2 upwards, the specific "
          "force");
    } else if (across < -0.8) {
      all_.emplace_back(
          "the IMU is mounted upside down against what is believed of it: gyroscope and gravity are both the "
          "other way round");
    } else if (across > 0.8 && together < 0.0) {
      all_.emplace_back("the gyroscope has the other sign about the vertical; its axes are not right-handed");
    }
  }

  /// Where axes are swapped or mirrored, the orthogonal matrix that fits the accelerations best turns a
  /// right-handed system into a left-handed one.
  void doubt_axes() {
    const Eigen::Matrix3d C = force_.measured.transpose() * force_.expected;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(C, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Matrix3d& U = svd.matrixU();
    const Eigen::Matrix3d& V = svd.matrixV();
    if ((U * V.transpose()).determinant() > 0.0) return;
    const auto left = [&](double last) {
      const Eigen::Matrix3d Q = U * Eigen::Vector3d(1.0, 1.0, last).asDiagonal() * V.transpose();
      return (force_.measured - force_.expected * Q.transpose()).squaredNorm();
    };
    if (left(1.0) > 0.25 * left(-1.0)) return;
    all_.push_back("the axes of the accelerometer are not right-handed: " + axes_text(U * V.transpose()));
  }

  /// How the columns would have to be taken so that the axes are those that are believed.
  std::string axes_text(const Eigen::Matrix3d& Q) const {
    const Eigen::Matrix3d P = Q * R_SE_.transpose();  // of the believed axes to those that were read
    std::string text;
    for (const SwappedAxis& axis : swapped_axes(P))
      text += fmt::format("{}what is read as {} is {}", text.empty() ? "" : ", ", axis.name, axis.is);
    return text.empty() ? "two are swapped, or one has the other sign" : text;
  }

  void doubt_values() {
    const auto doubt = [this](const char* what, double value, double deviation, const char* unit) {
      if (value <= largest_deviations * deviation) return;
      all_.push_back(
          fmt::format("the bias of the {} would be {:.2g} {}, and {:.2g} is believed possible; check its "
                      "sign, its unit and how it is mounted",
                      what, value, unit, largest_deviations * deviation));
    };
    doubt("gyroscope", fit_.pose.gyroscope_bias.cwiseAbs().maxCoeff(), belief_.gyroscope_bias_deviation,
          "rad/s");
    doubt("accelerometer", fit_.pose.accelerometer_bias.cwiseAbs().maxCoeff(),
          belief_.accelerometer_bias_deviation, "m/s^2");
    const double latest = 0.98 * belief_.largest_delay;
    if (std::abs(fit_.pose.delay) > latest) {
      all_.push_back(
          fmt::format("the IMU would be {:.1f} ms {}; more than {:.0f} ms cannot be told: check the clocks "
                      "of IMU and encoders",
                      1e3 * std::abs(fit_.pose.delay), fit_.pose.delay > 0.0 ? "late" : "early",
                      1e3 * belief_.largest_delay));
    }
  }

  const ImuBelief& belief_;
  const ImuPoseFit& fit_;
  Eigen::Matrix3d R_SE_;
  Rows turning_, force_;
  std::vector<std::string> all_;
};

}  // namespace

std::vector<std::string> warnings_about_imu(const std::vector<ImuStretch>& stretches, const ImuBelief& belief,
                                            const ImuPoseFit& fit) {
  return Doubts(stretches, belief, fit).take();
}

}  // namespace flinch
