#include "systems/safety/imu_errors.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

using Six = Eigen::Matrix<double, 6, 1>;

/// Force over turning, each in its deviations.
Six weighed(const Eigen::Vector3d& force, const Eigen::Vector3d& turning, const ImuSpread& spread) {
  Six both;
  both << force / spread.force, turning / spread.turning;
  return both;
}

/// Squares of what is left of the errors once p parameters have been fitted to them.
template <int p>
struct Fit {
  Eigen::Matrix<double, p, p> information = Eigen::Matrix<double, p, p>::Zero();
  Eigen::Matrix<double, p, 1> right = Eigen::Matrix<double, p, 1>::Zero();
  double squares = 0.0;

  void add(const Eigen::Matrix<double, 6, p>& columns, const Six& error) {
    information += columns.transpose() * columns;
    right += columns.transpose() * error;
    squares += error.squaredNorm();
  }
  double left() const {
    const Eigen::Matrix<double, p, p> regular =
        information + 1e-9 * (information.trace() + 1e-300) * Eigen::Matrix<double, p, p>::Identity();
    return std::max(squares - right.dot(regular.ldlt().solve(right)), 0.0);
  }
};

/// The rotation that takes what is expected nearest to what is said, both over their deviations (Wahba's
/// problem, by singular values), and the squares that it leaves.
class RotationFit {
 public:
  void add(const Eigen::Vector3d& expected, const Eigen::Vector3d& said) {
    correlation_ += said * expected.transpose();
    squares_ += expected.squaredNorm() + said.squaredNorm();
  }
  double left() const {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation_, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double handed = svd.matrixU().determinant() * svd.matrixV().determinant();
    const Eigen::Vector3d& s = svd.singularValues();
    return std::max(squares_ - 2.0 * (s[0] + s[1] + (handed < 0.0 ? -s[2] : s[2])), 0.0);
  }

 private:
  Eigen::Matrix3d correlation_ = Eigen::Matrix3d::Zero();
  double squares_ = 0.0;
};

Six second_difference(const ImuErrors& errors, std::size_t age, const ImuSpread& rest) {
  const ImuError &a = errors.back(age), &b = errors.back(age + 1), &c = errors.back(age + 2);
  return weighed(a.force - 2.0 * b.force + c.force, a.turning - 2.0 * b.turning + c.turning, rest);
}

/// What the drives' own noise makes of it, which the model follows up to a part of a sample.
Six driven(const ImuErrors& errors, std::size_t age, const ImuSpread& rest) {
  const ImuError &a = errors.back(age), &b = errors.back(age + 1), &c = errors.back(age + 2);
  return weighed(a.expected_force - 2.0 * b.expected_force + c.expected_force,
                 1e-3 * (a.turning_slope - b.turning_slope), rest)
      .cwiseAbs();
}

/// A second difference of white noise has six times its variance.
const double far = 4.0 * std::sqrt(6.0);

}  // namespace

int ImuErrors::contradicted() const noexcept {
  int sum = 0;
  for (std::size_t age = 0; age < held(); ++age) sum += back(age).contradicted ? 1 : 0;
  return sum;
}

bool jumped(const ImuErrors& errors, std::size_t age, const ImuSpread& rest) noexcept {
  if (errors.held() < age + 4 || !(rest.force > 0.0) || !(rest.turning > 0.0)) return false;
  const Six later = second_difference(errors, age, rest), earlier = second_difference(errors, age + 1, rest);
  const Six expected = driven(errors, age, rest).cwiseMax(driven(errors, age + 1, rest));
  const auto turns = later.array() * earlier.array() < 0.0;
  const auto is_far = later.array().abs().min(earlier.array().abs()) > far + expected.array();
  return (turns && is_far).any();
}

bool jumps(const ImuErrors& errors) noexcept {
  constexpr std::size_t watched = 12;
  constexpr int enough = 5;
  int found = 0;
  for (std::size_t age = 0; age < std::min(watched, errors.held()); ++age)
    found += errors.back(age).jumps ? 1 : 0;
  return found >= enough;
}

double lag(const ImuErrors& errors) noexcept {
  constexpr double least = 1.2e-3, most = 10e-3;  // [s]
  if (errors.held() < ImuErrors::most) return 0.0;
  double both = 0.0, slopes = 0.0, squares = 0.0;
  for (std::size_t age = 0; age < errors.held(); ++age) {
    const ImuError& each = errors.back(age);
    both -= each.unconfirmed.dot(each.force_slope);
    slopes += each.force_slope.squaredNorm();
    squares += each.unconfirmed.squaredNorm();
  }
  const double explained = both * both / std::max(slopes, 1e-9);
  const double delay = both / std::max(slopes, 1e-9);
  const bool is_late = delay > least && delay < most && explained > 0.7 * squares;
  return is_late ? std::sqrt(explained) : 0.0;
}

ImuDoubt explanation(const ImuErrors& errors, const ImuSpread& spread) noexcept {
  Fit<6> constant;
  Fit<1> delay;
  RotationFit rotation;
  int samples = 0;
  for (std::size_t age = 0; age < errors.held(); ++age) {
    const ImuError& each = errors.back(age);
    if (!each.contradicted) continue;
    ++samples;
    const Six error = weighed(each.force, each.turning, spread);
    constant.add(Eigen::Matrix<double, 6, 6>::Identity(), error);
    delay.add(-weighed(each.force_slope, each.turning_slope, spread), error);
    rotation.add(each.expected_force / spread.force, (each.expected_force + each.force) / spread.force);
    rotation.add(each.expected_turning / spread.turning,
                 (each.expected_turning + each.turning) / spread.turning);
  }
  const double price = std::log(6.0 * std::max(samples, 1));
  const std::array<double, 3> cost{constant.left() + 6.0 * price, rotation.left() + 3.0 * price,
                                   delay.left() + price};
  constexpr std::array doubts{ImuDoubt::biased, ImuDoubt::turned, ImuDoubt::late};
  const auto best = std::min_element(cost.begin(), cost.end());
  if (*best > 0.5 * constant.squares + 6.0 * price) return ImuDoubt::contradicted;
  return doubts[static_cast<std::size_t>(best - cost.begin())];
}

}  // namespace flinch
