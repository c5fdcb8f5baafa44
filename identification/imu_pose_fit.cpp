#include "identification/imu_pose_fit.h"

#include <ceres/ceres.h>
#include <ceres/cubic_interpolation.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "identification/ceres_fit.h"
#include "identification/robust_mean.h"
#include "systems/robot/rotation.h"

namespace flinch {
namespace {

constexpr double fitted_period = 5e-3;   // neighbouring samples say the same after the filter [s]
constexpr double cluster_length = 0.25;  // [s]
constexpr int starts = 8;

/// What the platform does as a function of time: angular velocity, angular acceleration, specific force.
class Reference {
 public:
  static constexpr int columns = 9;

  explicit Reference(const ImuStretch& stretch) : start_(stretch.start), period_(stretch.period) {
    const Eigen::Index n = stretch.specific_force.rows();
    data_.resize(static_cast<std::size_t>(n * columns));
    for (Eigen::Index k = 0; k < n; ++k) {
      double* const row = data_.data() + k * columns;
      for (int i = 0; i < 3; ++i) {
        row[i] = stretch.angular_velocity(k, i);
        row[3 + i] = stretch.angular_acceleration(k, i);
        row[6 + i] = stretch.specific_force(k, i);
      }
    }
    grid_ = std::make_unique<Grid>(data_.data(), 0, static_cast<int>(n));
    spline_ = std::make_unique<ceres::CubicInterpolator<Grid>>(*grid_);
  }

  template <class T>
  void at(const T& time, T* values) const {
    spline_->Evaluate((time - start_) / period_, values);
  }

 private:
  using Grid = ceres::Grid1D<double, columns>;
  double start_, period_;
  std::vector<double> data_;
  std::unique_ptr<Grid> grid_;
  std::unique_ptr<ceres::CubicInterpolator<Grid>> spline_;
};

/// A sample that is fitted.
struct Sample {
  const Reference* reference = nullptr;
  double time = 0.0;  ///< of its arrival [s]
  Eigen::Vector3d gyroscope, accelerometer;
  int cluster = 0, recording = 0;
};

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

/// What the sensor would say, in its axes and without bias.
template <class T>
void expected(const Sample& sample, const Eigen::Quaternion<T>& R_ES, const Vector3<T>& p, const T& delay,
              Vector3<T>& gyroscope, Vector3<T>& accelerometer) {
  std::array<T, Reference::columns> motion;
  sample.reference->at(T(sample.time) - delay, motion.data());
  const Vector3<T> w(motion[0], motion[1], motion[2]);
  const Vector3<T> dw(motion[3], motion[4], motion[5]);
  const Vector3<T> f(motion[6], motion[7], motion[8]);
  const Eigen::Quaternion<T> R_SE = R_ES.conjugate();
  gyroscope = R_SE * w;
  accelerometer = R_SE * Vector3<T>(f + dw.cross(p) + w.cross(w.cross(p)));
}

struct GyroscopeResidual {
  const Sample* sample;
  double sigma;

  template <class T>
  bool operator()(const T* const q, const T* const bias, const T* const delay, T* residual) const {
    Vector3<T> gyroscope, unused;
    expected<T>(*sample, Eigen::Map<const Eigen::Quaternion<T>>(q), Vector3<T>::Zero(), *delay, gyroscope,
                unused);
    for (int i = 0; i < 3; ++i) residual[i] = (sample->gyroscope[i] - gyroscope[i] - bias[i]) / sigma;
    return true;
  }
};

struct AccelerometerResidual {
  const Sample* sample;
  double sigma;

  template <class T>
  bool operator()(const T* const q, const T* const position, const T* const bias, const T* const delay,
                  T* residual) const {
    Vector3<T> unused, accelerometer;
    expected<T>(*sample, Eigen::Map<const Eigen::Quaternion<T>>(q), Eigen::Map<const Vector3<T>>(position),
                *delay, unused, accelerometer);
    for (int i = 0; i < 3; ++i) residual[i] = (sample->accelerometer[i] - accelerometer[i] - bias[i]) / sigma;
    return true;
  }
};

std::vector<Sample> samples_of(const std::vector<ImuStretch>& stretches,
                               const std::vector<std::unique_ptr<Reference>>& references) {
  std::vector<Sample> samples;
  int cluster = 0;
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    const ImuStretch& stretch = stretches[s];
    const auto step = std::max<Eigen::Index>(1, std::lround(fitted_period / stretch.period));
    const auto margin = static_cast<Eigen::Index>(ImuStretch::edge / stretch.period);
    cluster += 1000;
    for (Eigen::Index k = margin; k + margin < stretch.gyroscope.rows(); k += step) {
      if (stretch.usable[static_cast<std::size_t>(k)] == 0) continue;
      const double since = static_cast<double>(k) * stretch.period;
      samples.push_back({references[s].get(), stretch.start + since, stretch.gyroscope.row(k).transpose(),
                         stretch.accelerometer.row(k).transpose(),
                         cluster + static_cast<int>(since / cluster_length), stretch.recording});
    }
  }
  return samples;
}

std::vector<std::unique_ptr<Reference>> references_of(const std::vector<ImuStretch>& stretches) {
  std::vector<std::unique_ptr<Reference>> references;
  for (const ImuStretch& stretch : stretches) references.push_back(std::make_unique<Reference>(stretch));
  return references;
}

ImuResiduals residuals_of(const std::vector<Sample>& samples, const ImuPose& pose) {
  const auto n = static_cast<Eigen::Index>(samples.size());
  ImuResiduals out;
  for (Eigen::MatrixXd* m :
       {&out.gyroscope, &out.accelerometer, &out.measured_gyroscope, &out.measured_accelerometer})
    m->resize(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Sample& sample = samples[static_cast<std::size_t>(i)];
    Eigen::Vector3d gyroscope, accelerometer;
    expected<double>(sample, pose.R_ES, pose.position, pose.delay, gyroscope, accelerometer);
    out.gyroscope.row(i) = (sample.gyroscope - gyroscope - pose.gyroscope_bias).transpose();
    out.accelerometer.row(i) = (sample.accelerometer - accelerometer - pose.accelerometer_bias).transpose();
    out.measured_gyroscope.row(i) = sample.gyroscope.transpose();
    out.measured_accelerometer.row(i) = sample.accelerometer.transpose();
    out.time.push_back(sample.time);
  }
  return out;
}

double deviation(const Eigen::MatrixXd& residuals) {
  return robust_deviation({residuals.data(), residuals.data() + residuals.size()});
}

class Fit {
 public:
  Fit(const std::vector<Sample>& samples, const ImuBelief& belief, const ImuPose& start)
      : samples_(samples), belief_(belief), pose_(start) {
    const ImuResiduals scale = residuals_of(samples, {});
    sigma_w_ = 0.1 * scale.measured_gyroscope.cwiseAbs().maxCoeff() + 1e-9;  // those of (10), to begin with
    sigma_a_ = 0.1 * scale.measured_accelerometer.cwiseAbs().maxCoeff() + 1e-9;
  }

  void solve(Loss loss) {
    problem_ = std::make_unique<ceres::Problem>();
    blocks_.clear();
    for (const Sample& sample : samples_) {
      blocks_.push_back(problem_->AddResidualBlock(
          new ceres::AutoDiffCostFunction<GyroscopeResidual, 3, 4, 3, 1>(
              new GyroscopeResidual{&sample, sigma_w_}),
          loss_function(loss), pose_.R_ES.coeffs().data(), pose_.gyroscope_bias.data(), &pose_.delay));
      blocks_.push_back(
          problem_->AddResidualBlock(new ceres::AutoDiffCostFunction<AccelerometerResidual, 3, 4, 3, 3, 1>(
                                         new AccelerometerResidual{&sample, sigma_a_}),
                                     loss_function(loss), pose_.R_ES.coeffs().data(), pose_.position.data(),
                                     pose_.accelerometer_bias.data(), &pose_.delay));
    }
    problem_->SetManifold(pose_.R_ES.coeffs().data(), new ceres::EigenQuaternionManifold);
    problem_->SetParameterLowerBound(&pose_.delay, 0, 0.0);
    problem_->SetParameterUpperBound(&pose_.delay, 0, belief_.largest_delay);
    believe(pose_.position, belief_.mount.position_in_platform, belief_.position_deviation);
    believe(pose_.gyroscope_bias, Eigen::Vector3d::Zero(), belief_.gyroscope_bias_deviation);
    believe(pose_.accelerometer_bias, Eigen::Vector3d::Zero(), belief_.accelerometer_bias_deviation);
    solve_problem(*problem_);
    pose_.R_ES.normalize();
  }

  double cost() {
    double cost = 0.0;
    problem_->Evaluate({}, &cost, nullptr, nullptr, nullptr);
    return cost;
  }

  void rescale() {
    const ImuResiduals left = residuals_of(samples_, pose_);
    sigma_w_ = deviation(left.gyroscope) + 1e-9;
    sigma_a_ = deviation(left.accelerometer) + 1e-9;
  }

  const ImuPose& pose() const { return pose_; }

  ImuPoseFit take(Loss loss) {
    ImuPoseFit fit;
    fit.pose = pose_;
    fit.cost = cost();
    fit.gyroscope_deviation = sigma_w_;
    fit.accelerometer_deviation = sigma_a_;
    fit.linear = linearised(*problem_, blocks_,
                            {pose_.R_ES.coeffs().data(), pose_.position.data(), pose_.gyroscope_bias.data(),
                             pose_.accelerometer_bias.data(), &pose_.delay},
                            loss);
    fit.linear.jacobian.leftCols(3) *= 0.5;  // the manifold counts half of the rotation vector
    for (const Sample& sample : samples_) {
      for (int row = 0; row < 6; ++row) {
        fit.linear.cluster.push_back(sample.cluster);
        fit.linear.recording.push_back(sample.recording);
      }
    }
    Eigen::VectorXd deviations(13);
    deviations << Eigen::Vector3d::Constant(1e9), Eigen::Vector3d::Constant(belief_.position_deviation),
        Eigen::Vector3d::Constant(belief_.gyroscope_bias_deviation),
        Eigen::Vector3d::Constant(belief_.accelerometer_bias_deviation), belief_.largest_delay;
    fit.linear.prior_information = deviations.cwiseAbs2().cwiseInverse();
    return fit;
  }

 private:
  void believe(Eigen::Vector3d& values, const Eigen::Vector3d& mean, double sigma) {
    add_belief(*problem_, values.data(), mean, Eigen::Vector3d::Constant(sigma));
  }

  const std::vector<Sample>& samples_;
  const ImuBelief& belief_;
  ImuPose pose_;
  double sigma_w_, sigma_a_;
  std::unique_ptr<ceres::Problem> problem_;
  std::vector<ceres::ResidualBlockId> blocks_;
};

}  // namespace

ImuPoseFit fit_imu_pose(const std::vector<ImuStretch>& stretches, const ImuBelief& belief) {
  const auto references = references_of(stretches);
  const std::vector<Sample> samples = samples_of(stretches, references);
  std::vector<Sample> few;
  for (std::size_t i = 0; i < samples.size(); i += 1 + samples.size() / 500) few.push_back(samples[i]);
  ImuPose best;
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start < starts; ++start) {
    ImuPose from;
    from.R_ES = Eigen::AngleAxisd(2.0 * std::numbers::pi * start / starts, Eigen::Vector3d::UnitZ());
    from.position = belief.mount.position_in_platform;
    from.delay = 0.3 * belief.largest_delay;
    Fit fit(few, belief, from);
    fit.solve(Loss::huber);
    if (fit.cost() < least) {
      least = fit.cost();
      best = fit.pose();
    }
  }
  Fit fit(samples, belief, best);
  for (const Loss loss : {Loss::huber, Loss::huber, Loss::tukey, Loss::tukey}) {
    fit.solve(loss);
    fit.rescale();
  }
  fit.solve(Loss::tukey);
  return fit.take(Loss::tukey);
}

ImuResiduals imu_residuals(const std::vector<ImuStretch>& stretches, const ImuPose& pose) {
  const auto references = references_of(stretches);
  return residuals_of(samples_of(stretches, references), pose);
}

Eigen::Quaterniond turned(const Eigen::Quaterniond& R_ES, const Eigen::Vector3d& by) {
  const Eigen::Vector4d q = quaternion_exp(by);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * R_ES;
}

// R_ES = Rx(a) Ry(b) Rz(c).
Eigen::Vector3d mount_angles(const Eigen::Quaterniond& R_ES) {
  const Eigen::Matrix3d R = R_ES.toRotationMatrix();
  return {std::atan2(-R(1, 2), R(2, 2)), std::asin(std::clamp(R(0, 2), -1.0, 1.0)),
          std::atan2(-R(0, 1), R(0, 0))};
}

}  // namespace flinch
