#include "identification/motion_warnings.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "identification/likely_scale.h"

namespace flinch {
namespace {

constexpr double clear = 0.6;            // correlation, of which the sign is no chance
constexpr double sure = 0.9;             // from it on a factor is no chance
constexpr double largest_change = 1.25;  // of all torques against what is believed
constexpr double largest_deviations = 5.0;
constexpr std::size_t most_told = 3;

/// How the measured torque of a drive follows what the robot should need.
struct Answer {
  double correlation = 0.0;
  double ratio = 0.0;  ///< of their deviations
};

Answer answer_of(const DynamicsRows& rows, int drive) {
  const Eigen::VectorXd measured = of_drive(rows, rows.torque, drive);
  const Eigen::VectorXd needed = of_drive(rows, rows.torque - rows.surplus, drive);
  if (measured.size() < 2) return {};
  const Eigen::ArrayXd m = measured.array() - measured.mean(), n = needed.array() - needed.mean();
  const double mm = m.square().sum(), nn = n.square().sum();
  if (!(mm > 0.0) || !(nn > 0.0)) return {};
  return {(m * n).sum() / std::sqrt(mm * nn), std::sqrt(mm / nn)};
}

}  // namespace

std::vector<std::string> warnings_about_motion(const DynamicsRows& rows, int drives) {
  std::vector<Answer> answers;
  std::vector<int> other;
  for (int i = 0; i < drives; ++i) {
    answers.push_back(answer_of(rows, i));
    if (answers.back().correlation < -clear) other.push_back(i + 1);
  }
  if (static_cast<int>(other.size()) == drives)
    return {"the currents of all drives have the other sign: they must be positive where their torque is"};
  if (!other.empty())
    return {fmt::format("the current of drive {} has the other sign: it must be positive where its torque is",
                        fmt::join(other, ", "))};
  std::vector<double> ratios;
  for (const Answer& answer : answers) {
    if (answer.correlation > sure) ratios.push_back(answer.ratio);
  }
  if (static_cast<int>(ratios.size()) < drives) return {};
  const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
  const double middle = std::sqrt(*least * *most);
  const bool alike = *most < largest_change * *least;
  const std::optional<std::string> cause = likely_cause(middle, causes_of_currents());
  if (alike && cause)
    return {fmt::format(
        "all torques are {} what the robot needs for its motion: currents or torque constants are of "
        "another unit; {}",
        factor_text(middle), *cause)};
  if (alike && (middle > 2.0 || middle < 0.5))
    return {fmt::format(
        "all torques are {} what the robot needs for its motion; check the unit of the currents and the "
        "torque constants",
        factor_text(middle))};
  return {};
}

std::vector<std::string> warnings_about_values(const DynamicParameters& parameters,
                                               const Eigen::VectorXd& values, const std::vector<bool>& held) {
  struct Far {
    double deviations;
    std::string sentence;
  };
  std::vector<Far> far;
  for (std::size_t j = 0; j < parameters.list().size(); ++j) {
    const DynamicParameter& believed = parameters.list()[j];
    if (held[j] || believed.name.empty() || !(believed.deviation > 0.0)) continue;
    const double value = values[static_cast<Eigen::Index>(j)];
    const double deviations = std::abs(value - believed.believed) / believed.deviation;
    if (deviations < largest_deviations) continue;
    far.push_back(
        {deviations,
         fmt::format(
             "{} would be {:.4g} {}, which is {:.1f} deviations of its belief, {:.4g} +- {:.2g}, away",
             believed.name, value, believed.unit, deviations, believed.believed, believed.deviation)});
  }
  std::stable_sort(far.begin(), far.end(),
                   [](const Far& a, const Far& b) { return a.deviations > b.deviations; });
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < std::min(far.size(), most_told); ++i) warnings.push_back(far[i].sentence);
  return warnings;
}

}  // namespace flinch
