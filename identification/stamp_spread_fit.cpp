#include "identification/stamp_spread_fit.h"

#include <algorithm>
#include <cmath>

#include "systems/foundation/median.h"
#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

constexpr double longest_gap = 3.0;     // usual ones between samples of one bend
constexpr double most_squared = 25.0;   // a bend that is more unlikely is another failure's
constexpr double slope_lost = 0.03;     // share of a slope that the filter of the encoders may take
constexpr double significant = 3.0;     // deviations
constexpr double least_telling = 3e-4;  // a width that must be seen where it is there [s]

/// What of a reading is not expected at its stamp, and the slope of what is.
struct Error {
  double time;
  Eigen::Vector3d value, slope;
};

std::vector<Error> errors_of(const ImuStretch& stretch, const ImuPose& pose) {
  const Eigen::MatrixXd expected = stretch.angular_velocity * pose.R_ES.toRotationMatrix();
  const Eigen::MatrixXd slope = stretch.angular_acceleration * pose.R_ES.toRotationMatrix();
  const double late = pose.delay - stretch.stamped_age, last = static_cast<double>(expected.rows()) - 2.0;
  std::vector<Error> errors;
  for (const GyroscopeSample& sample : stretch.rates) {
    const double at = (sample.acquired - late - stretch.start) / stretch.period;
    if (at < ImuStretch::edge / stretch.period || at > last - ImuStretch::edge / stretch.period) continue;
    const auto k = static_cast<Eigen::Index>(at);
    const double share = at - static_cast<double>(k);
    const Eigen::Vector3d then = ((1.0 - share) * expected.row(k) + share * expected.row(k + 1)).transpose();
    errors.push_back({sample.acquired, sample.rate - then, slope.row(k).transpose()});
  }
  return errors;
}

/// A squared bend over c_k, and the squared slope.
struct Bend {
  double squared, slope_squared;
};

/// Time from one sample to the next, in the middle of all.
double usual_spacing(const std::vector<Error>& errors) {
  std::vector<double> spacings;
  for (std::size_t k = 1; k < errors.size(); ++k) spacings.push_back(errors[k].time - errors[k - 1].time);
  return median(std::move(spacings));
}

void add_bends(const std::vector<Error>& errors, std::vector<Bend>& bends) {
  const double usual = usual_spacing(errors);
  for (std::size_t k = 1; k + 1 < errors.size(); k += 3) {
    const Error &before = errors[k - 1], &now = errors[k], &after = errors[k + 1];
    const double since = now.time - before.time, until = after.time - now.time;
    if (!(since > 0.0 && until > 0.0) || std::max(since, until) > longest_gap * usual) continue;
    const double of_before = until / (since + until), of_after = since / (since + until);
    const double c = 1.0 + of_before * of_before + of_after * of_after;
    const Eigen::Vector3d bend = now.value - of_before * before.value - of_after * after.value;
    for (int i = 0; i < 3; ++i) bends.push_back({bend[i] * bend[i] / c, now.slope[i] * now.slope[i]});
  }
}

/// s^2 and sigma^2, and their covariance.
struct Variances {
  Eigen::Vector2d value{0.0, 0.0};
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

Variances fit(const std::vector<Bend>& bends) {
  constexpr int rounds = 30;
  constexpr double median_over_mean = 0.455;  // of squares of normal numbers
  std::vector<double> squares;
  for (const Bend& bend : bends) squares.push_back(bend.squared);
  Variances fitted;
  fitted.value[0] = median(std::move(squares)) / median_over_mean;
  for (int round = 0; round < rounds; ++round) {
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right(0.0, 0.0);
    for (const Bend& bend : bends) {
      const Eigen::Vector2d row(1.0, bend.slope_squared);
      const double variance = row.dot(fitted.value);
      if (!(variance > 0.0) || bend.squared > most_squared * variance) continue;
      const double weight = 0.5 / (variance * variance);  // a normal number's square has the variance 2
      information += weight * row * row.transpose();
      right += weight * bend.squared * row;
    }
    const Eigen::LDLT<Eigen::Matrix2d> solver(information);
    fitted.value = solver.solve(right).cwiseMax(0.0);
    fitted.covariance = solver.solve(Eigen::Matrix2d::Identity());
  }
  return fitted;
}

}  // namespace

std::optional<StampSpread> fit_stamp_spread(const std::vector<ImuStretch>& stretches, const ImuPose& pose) {
  std::vector<Bend> bends;
  for (const ImuStretch& stretch : stretches) add_bends(errors_of(stretch, pose), bends);
  if (bends.empty()) return {};
  const Variances fitted = fit(bends);
  const double variance = 12.0 * fitted.value[1];  // of a width w: w^2 / 12
  const double deviation = 12.0 * std::sqrt(fitted.covariance(1, 1));
  if (variance > significant * deviation) {
    const double width = std::sqrt(variance);
    return StampSpread{width, std::hypot(0.5 * deviation / width, slope_lost * width)};
  }
  if (significant * deviation < least_telling * least_telling) return StampSpread{0.0, std::sqrt(deviation)};
  return {};
}

}  // namespace flinch
