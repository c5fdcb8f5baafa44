#include "systems/safety/imu_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "systems/robot/decompositions.h"
#include "systems/signals/sampling.h"

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

/// Sums of the samples so far: of what the encoders do not show, and of the motion itself, whose rate the
/// encoders tell with less noise.
struct SummedAxes {
  explicit SummedAxes(const ImuError& oldest) : first(oldest.force + oldest.expected_force) {}

  void add(const ImuError& each) {
    const double T = to_seconds(each.spacing);
    speed_unseen += T * each.force_unseen;
    position_unseen += T * speed_unseen;
    angle_unseen += T * each.turning_unseen;
    speed += T * (each.force + each.expected_force - first);
    rate = each.expected_turning;
  }

  Eigen::Vector3d first;
  Eigen::Vector3d speed_unseen{0.0, 0.0, 0.0}, position_unseen{0.0, 0.0, 0.0}, angle_unseen{0.0, 0.0, 0.0};
  Eigen::Vector3d speed{0.0, 0.0, 0.0}, rate{0.0, 0.0, 0.0};
};

/// Products of two signals of three axes each, less what a constant explains of them, or a straight line.
class Products {
 public:
  void add(const Eigen::Array3d& y, const Eigen::Array3d& x, double at) {
    yy_ += y * y, yx_ += y * x, xx_ += x * x;
    y_ += y, x_ += x, yt_ += at * y, xt_ += at * x;
    count_ += 1.0, tt_ += at * at;
  }
  /// Of y with y, y with x and x with x; `line`: a straight one is free.
  std::array<Eigen::Array3d, 3> left(bool line) const {
    const double slope = line ? 1.0 / tt_ : 0.0;
    return {yy_ - y_ * y_ / count_ - slope * yt_ * yt_, yx_ - y_ * x_ / count_ - slope * yt_ * xt_,
            xx_ - x_ * x_ / count_ - slope * xt_ * xt_};
  }

 private:
  using Axes = Eigen::Array3d;
  Axes yy_ = Axes::Zero(), yx_ = Axes::Zero(), xx_ = Axes::Zero();
  Axes y_ = Axes::Zero(), x_ = Axes::Zero(), yt_ = Axes::Zero(), xt_ = Axes::Zero();
  double count_ = 0.0, tt_ = 0.0;
};

/// Least squares for the time by which all axes are late.
class LatenessFit {
 public:
  /// `middle`: the mean of the times of all samples [ms].
  explicit LatenessFit(double middle) : middle_(middle) {}

  /// Sums up to a sample at `time` [ms].
  void add(const SummedAxes& sums, double time) {
    const double at = time - middle_;
    positions_.add(sums.position_unseen.array(), -sums.speed.array(), at);
    angles_.add(sums.angle_unseen.array(), -sums.rate.array(), at);
  }
  Lateness solve(const Eigen::Array3d& position_variance, const Eigen::Array3d& angle_variance) const {
    const auto positions = positions_.left(true), angles = angles_.left(false);
    std::array<double, 3> sums{};
    for (std::size_t i = 0; i < sums.size(); ++i)
      sums[i] = (positions[i] / position_variance + angles[i] / angle_variance).sum();
    const auto [squares, right, information] = sums;
    if (!(information > 0.0)) return {};
    return {right / information, 1.0 / std::sqrt(information), right * right / (information * squares)};
  }

 private:
  double middle_;
  Products positions_, angles_;
};

/// Three samples in a row, and their weights in a second difference, which no straight line has: 1, -2 and 1
/// where they are equally far apart.
struct Bend {
  const ImuError &a, &b, &c;
  double of_a, of_c;

  Bend(const ImuErrors& errors, std::size_t age)
      : a(errors.back(age)), b(errors.back(age + 1)), c(errors.back(age + 2)) {
    const double later = to_seconds(a.spacing), earlier = to_seconds(b.spacing);
    of_a = 2.0 * earlier / (later + earlier);
    of_c = 2.0 * later / (later + earlier);
  }
};

double milliseconds(Time time) { return static_cast<double>(time.count()) / 1e6; }

Six second_difference(const ImuErrors& errors, std::size_t age, const ImuSpread& rest) {
  const auto [a, b, c, of_a, of_c] = Bend(errors, age);
  return weighed(of_a * a.force - 2.0 * b.force + of_c * c.force,
                 of_a * a.turning - 2.0 * b.turning + of_c * c.turning, rest);
}

/// Of what the unit says, whatever it comes from, over some samples from `age` back; without its sign.
Six measured_slope(const ImuErrors& errors, std::size_t age, const ImuSpread& rest) {
  const std::size_t oldest = std::min(age + 4, errors.held() - 1);
  double time = 0.0;
  for (std::size_t k = age; k < oldest; ++k) time += to_seconds(errors.back(k).spacing);
  const ImuError &last = errors.back(age), &first = errors.back(oldest);
  const Eigen::Vector3d force = last.force + last.expected_force - first.force - first.expected_force;
  const Eigen::Vector3d turning =
      last.turning + last.expected_turning - first.turning - first.expected_turning;
  return weighed(force, turning, rest).cwiseAbs() / time;
}

/// What the drives' own noise makes of it, which the model follows up to a part of a sample, and up to how
/// far they have gone at each.
Six driven(const ImuErrors& errors, std::size_t age, const ImuSpread& rest) {
  const auto [a, b, c, of_a, of_c] = Bend(errors, age);
  const Eigen::Vector3d rising =
      of_a * a.rising.cwiseAbs() + 2.0 * b.rising.cwiseAbs() + of_c * c.rising.cwiseAbs();
  const Eigen::Vector3d bent = of_a * a.expected_force - 2.0 * b.expected_force + of_c * c.expected_force;
  Six found = weighed(bent.cwiseAbs() + rising,
                      (of_a * to_seconds(a.spacing) * (a.turning_slope - b.turning_slope)).cwiseAbs(), rest);
  const double stamps = of_a * a.stamp_spread + of_c * c.stamp_spread;  // at most, all halves of one sign
  if (stamps > 0.0) found += stamps * measured_slope(errors, age, rest);
  return found;
}

constexpr double white = 6.0;            // square of the second difference of white noise, at equal distances
constexpr double far = 4.0;              // deviations
constexpr double usual_time = 0.25;      // time constant [s]
constexpr double largest_counted = 9.0;  // times what is usual

}  // namespace

int ImuErrors::contradicted(int latest) const noexcept {
  int sum = 0;
  const auto asked = static_cast<std::size_t>(std::min(latest, judged));
  for (std::size_t age = 0; age < std::min(held(), asked); ++age) sum += back(age).contradicted ? 1 : 0;
  return sum;
}

void UsualBends::follow(const ImuErrors& errors, const ImuSpread& rest) noexcept {
  if (errors.held() < 3 || !(rest.force > 0.0) || !(rest.turning > 0.0)) return;
  const Six now = second_difference(errors, 0, rest).cwiseAbs2().cwiseMin(largest_counted * squares);
  const double share = 1.0 - std::exp(-to_seconds(errors.back(0).spacing) / usual_time);
  squares = (squares + share * (now - squares)).cwiseMax(white);
}

bool jumped(const ImuErrors& errors, std::size_t age, const ImuSpread& rest,
            const UsualBends& usual) noexcept {
  if (errors.held() < age + 4 || !(rest.force > 0.0) || !(rest.turning > 0.0)) return false;
  const Six later = second_difference(errors, age, rest), earlier = second_difference(errors, age + 1, rest);
  const Six expected = driven(errors, age, rest).cwiseMax(driven(errors, age + 1, rest));
  const auto turns = later.array() * earlier.array() < 0.0;
  const auto is_far =
      later.array().abs().min(earlier.array().abs()) > far * usual.squares.array().sqrt() + expected.array();
  return (turns && is_far).any();
}

namespace {

/// How many of the last twelve samples do.
int jumped_lately(const ImuErrors& errors) noexcept {
  constexpr std::size_t watched = 12;
  int found = 0;
  for (std::size_t age = 0; age < std::min(watched, errors.held()); ++age)
    found += errors.back(age).jumps ? 1 : 0;
  return found;
}

}  // namespace

bool jumps(const ImuErrors& errors) noexcept {
  constexpr int enough = 5;
  return jumped_lately(errors) >= enough;
}

Lateness lateness(const ImuErrors& errors, std::size_t samples, const EncoderSpread& encoders,
                  const ImuSpread& unit) noexcept {
  if (errors.held() < samples) return {};
  const Time before = -errors.back(samples - 1).spacing;  // with the oldest at zero
  Time time = before;
  double middle = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    time += errors.back(samples - 1 - k).spacing;
    middle += milliseconds(time) / static_cast<double>(samples);
  }
  const double whole = to_seconds(time - before);
  SummedAxes sums(errors.back(samples - 1));
  LatenessFit fit(middle);
  time = before;
  for (std::size_t k = 0; k < samples; ++k) {
    const ImuError& each = errors.back(samples - 1 - k);
    time += each.spacing;
    sums.add(each);
    fit.add(sums, milliseconds(time));
  }
  // What is slow weighs most: of white noise that is summed up, half a period in all the samples.
  const double slow = whole / std::numbers::pi;
  const double turned = unit.turning * slow, moved = unit.force * slow * slow;
  return fit.solve(encoders.position.array().square() + moved * moved,
                   encoders.angle.array().square() + turned * turned);
}

bool is_late(const ImuErrors& errors, const EncoderSpread& encoders, const ImuSpread& unit,
             Time spacing) noexcept {
  if (errors.held() == 0) return false;
  const double least = 0.7e-3 + 0.5 * errors.back(0).stamp_spread;  // [s]
  constexpr double most = 10e-3;
  for (const Time window : {10ms, 20ms}) {
    const auto samples = static_cast<std::size_t>(periods_in(window, spacing, 5));
    const Lateness found = lateness(errors, samples, encoders, unit);
    if (found.deviation > 0.0 && found.time > least + 5.0 * found.deviation && found.time < most &&
        found.explained > 0.7)
      return true;
  }
  return false;
}

ImuFault explanation(const ImuErrors& errors, const ImuSpread& spread) noexcept {
  Fit<6> constant;
  Fit<1> delay;
  RotationFit rotation;
  int samples = 0;
  for (std::size_t age = 0; age < std::min<std::size_t>(errors.held(), ImuErrors::judged); ++age) {
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
  constexpr std::array doubts{ImuFault::biased, ImuFault::turned, ImuFault::late};
  const auto best = std::min_element(cost.begin(), cost.end());
  constexpr int few = 3;  // jumps of a unit that is contradicted anyway
  if (*best > 0.5 * constant.squares + 6.0 * price)
    return jumped_lately(errors) >= few ? ImuFault::noisy : ImuFault::contradicted;
  return doubts[static_cast<std::size_t>(best - cost.begin())];
}

}  // namespace flinch
