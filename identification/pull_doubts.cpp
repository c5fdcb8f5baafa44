#include "identification/pull_doubts.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "identification/likely_scale.h"
#include "identification/swapped_axes.h"

namespace flinch {
namespace {

constexpr double clear = 0.5;            // correlation, of which the sign is no chance
constexpr double poor = 0.85;            // below it axes are tried
constexpr double good = 0.95;            // from it on they explain it
constexpr double largest_change = 1.25;  // of a torque constant against what is believed

/// How the current of a drive follows the torque that it must hold.
struct Answer {
  double correlation = 0.0;
  double slope = 0.0;  ///< of the torque over the current [Nm/A or N/A]
};

/// With the axes of the instrument turned: those of the window are `axes` times those that were read.
Answer answer_of(const std::vector<PullWindow>& windows, int drive, const Eigen::Matrix3d& axes) {
  const double handed = axes.determinant();  // a moment is no vector but the sense of a turn
  double si = 0.0, st = 0.0, sii = 0.0, stt = 0.0, sit = 0.0, n = 0.0;
  for (const PullWindow& window : windows) {
    const Eigen::Vector3d force = axes * window.force, moment = handed * (axes * window.moment);
    const double pulled = window.force_map.row(drive).dot(force) + window.moment_map.row(drive).dot(moment);
    const double torque = window.model_effort[drive] - pulled, current = window.current[drive];
    si += current, st += torque, sii += current * current, stt += torque * torque, sit += current * torque;
    n += 1.0;
  }
  const double vi = sii - si * si / n, vt = stt - st * st / n, c = sit - si * st / n;
  if (!(vi > 0.0) || !(vt > 0.0)) return {};
  // Both are noisy: the slope between those of either by the other.
  return {c / std::sqrt(vi * vt), std::copysign(std::sqrt(vt / vi), c)};
}

std::vector<Answer> answers(const std::vector<PullWindow>& windows, Eigen::Index drives,
                            const Eigen::Matrix3d& axes) {
  std::vector<Answer> all;
  for (int i = 0; i < drives; ++i) all.push_back(answer_of(windows, i, axes));
  return all;
}

double least_correlation(const std::vector<Answer>& answers) {
  double least = 1.0;
  for (const Answer& answer : answers) least = std::min(least, std::abs(answer.correlation));
  return least;
}

/// All ways to take the axes of an instrument for one another.
std::vector<Eigen::Matrix3d> signed_permutations() {
  std::vector<Eigen::Matrix3d> all;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
      for (unsigned i = 0; i < 3; ++i)
        axes(static_cast<int>(i), order[i]) = (signs >> i & 1U) != 0 ? -1.0 : 1.0;
      all.push_back(axes);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

std::string axes_text(const Eigen::Matrix3d& axes) {
  std::vector<std::string> parts;
  for (const SwappedAxis& axis : swapped_axes(axes))
    parts.push_back(fmt::format("its {} is {} as it was read", axis.name, axis.is));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<std::string> doubts_about_signs(const std::vector<Answer>& answers) {
  std::vector<int> other;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (answers[i].correlation < -clear) other.push_back(static_cast<int>(i) + 1);
  }
  if (other.empty()) return {};
  if (other.size() == answers.size())
    return {
        "what the instrument says has the other sign: it must be the force on the robot, and not that on the "
        "instrument; or all currents have the other sign"};
  return {fmt::format("the current of drive {} has the other sign: it must be positive where its torque is",
                      fmt::join(other, ", "))};
}

std::vector<std::string> doubts_about_constants(const std::vector<Answer>& answers,
                                                const JointVector& believed) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < answers.size(); ++i)
    ratios.push_back(answers[i].slope / believed[static_cast<Eigen::Index>(i)]);
  const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
  const double middle = std::sqrt(*least * *most);
  // A constant in [Nm/A] is too large by what the current is too small.
  const std::optional<std::string> cause = likely_cause(1.0 / middle, causes_of_currents());
  if (cause && *most < largest_change * *least)
    return {fmt::format(
        "torque constants would be {} those believed: the currents are {} what they should be; {}",
        factor_text(middle), factor_text(1.0 / middle), *cause)};
  std::vector<std::string> doubts;
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    if (ratios[i] < largest_change && ratios[i] > 1.0 / largest_change) continue;
    const std::optional<std::string> own = likely_cause(1.0 / ratios[i], causes_of_currents());
    doubts.push_back(fmt::format("the torque constant of drive {} would be {} what is believed{}", i + 1,
                                 factor_text(ratios[i]),
                                 own ? ": its current is in another unit; " + *own
                                     : std::string("; check its gear, its amplifier and its unit")));
  }
  return doubts;
}

}  // namespace

std::vector<std::string> doubts_about_pulls(const std::vector<PullWindow>& windows,
                                            const JointVector& believed) {
  const std::vector<Answer> own = answers(windows, believed.size(), Eigen::Matrix3d::Identity());
  if (least_correlation(own) < poor) {
    const Eigen::Matrix3d* best = nullptr;
    double most = good;
    const std::vector<Eigen::Matrix3d> tried = signed_permutations();
    for (const Eigen::Matrix3d& axes : tried) {
      const std::vector<Answer> with = answers(windows, believed.size(), axes);
      const bool right = std::all_of(with.begin(), with.end(), [](const Answer& a) { return a.slope > 0.0; });
      if (!right || least_correlation(with) <= most) continue;
      most = least_correlation(with);
      best = &axes;
    }
    if (best != nullptr)
      return {"axes of the instrument are swapped or mirrored: the currents answer its forces only where " +
              axes_text(*best)};
  }
  std::vector<std::string> doubts = doubts_about_signs(own);
  if (!doubts.empty()) return doubts;
  if (least_correlation(own) < poor) return {};  // nothing is clear enough to name a cause
  return doubts_about_constants(own, believed);
}

}  // namespace flinch
