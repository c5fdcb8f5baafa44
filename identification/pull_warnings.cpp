#include "identification/pull_warnings.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "identification/likely_scale.h"
#include "identification/swapped_axes.h"
#include "systems/robot/decompositions.h"

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

/// Whose axes were taken for one another.
enum class Frame { instrument, base };

/// With the axes of a frame turned or scaled: what the instrument says is `turned` times what was read.
Answer answer_of(const std::vector<PullWindow>& windows, int drive, Frame frame,
                 const Eigen::Matrix3d& turned) {
  const double handed =
      std::copysign(1.0, turned.determinant());  // a moment is no vector but the sense of a turn
  double si = 0.0, st = 0.0, sii = 0.0, stt = 0.0, sit = 0.0, n = 0.0;
  for (const PullWindow& window : windows) {
    const Eigen::Matrix3d axes =
        frame == Frame::instrument ? turned : window.axes.transpose() * turned * window.axes;
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

std::vector<Answer> answers(const std::vector<PullWindow>& windows, Eigen::Index drives, Frame frame,
                            const Eigen::Matrix3d& turned) {
  std::vector<Answer> all;
  for (int i = 0; i < drives; ++i) all.push_back(answer_of(windows, i, frame, turned));
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

std::vector<std::string> warnings_about_signs(const std::vector<Answer>& answers) {
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

std::vector<std::string> warnings_about_constants(const std::vector<Answer>& answers,
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
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    if (ratios[i] < largest_change && ratios[i] > 1.0 / largest_change) continue;
    const std::optional<std::string> own = likely_cause(1.0 / ratios[i], causes_of_currents());
    warnings.push_back(fmt::format("the torque constant of drive {} would be {} what is believed{}", i + 1,
                                   factor_text(ratios[i]),
                                   own ? ": its current is in another unit; " + *own
                                       : std::string("; check its gear, its amplifier and its unit")));
  }
  return warnings;
}

/// With the forces of the instrument in another unit, under which the torque constants are those believed.
std::optional<std::string> doubt_about_unit(const std::vector<PullWindow>& windows,
                                            const JointVector& believed) {
  for (const ScaleCause& each : causes_of_instruments()) {
    const std::vector<Answer> with =
        answers(windows, believed.size(), Frame::instrument, Eigen::Matrix3d::Identity() / each.factor);
    bool explains = least_correlation(with) > good;
    for (std::size_t i = 0; i < with.size(); ++i) {
      const double ratio = with[i].slope / believed[static_cast<Eigen::Index>(i)];
      explains = explains && ratio < largest_change && ratio > 1.0 / largest_change;
    }
    if (explains)
      return fmt::format("what the instrument says is {} what the currents answer; {}",
                         factor_text(each.factor), each.cause);
  }
  return std::nullopt;
}

/// With axes turned, under which the currents answer the instrument's forces better than `own`.
std::optional<std::string> doubt_about_axes(const std::vector<PullWindow>& windows, Eigen::Index drives,
                                            const std::vector<Answer>& own) {
  double most = std::max(good, least_correlation(own));
  std::optional<std::string> best;
  for (const Frame frame : {Frame::instrument, Frame::base}) {
    for (const Eigen::Matrix3d& turned : signed_permutations()) {
      const std::vector<Answer> with = answers(windows, drives, frame, turned);
      const bool right = std::all_of(with.begin(), with.end(), [](const Answer& a) { return a.slope > 0.0; });
      if (!right || least_correlation(with) <= most) continue;
      most = least_correlation(with);
      best = fmt::format(
          "axes {} are swapped or mirrored: the currents answer its forces only where {}",
          frame == Frame::instrument ? "of the instrument" : "of the base frame in which it tells its forces",
          axes_text(turned));
    }
  }
  return best;
}

}  // namespace

std::vector<std::string> warnings_about_pulls(const std::vector<PullWindow>& windows,
                                              const JointVector& believed) {
  const std::vector<Answer> own =
      answers(windows, believed.size(), Frame::instrument, Eigen::Matrix3d::Identity());
  const std::vector<std::string> of_signs = warnings_about_signs(own);
  const bool is_poor = least_correlation(own) < poor;
  if (const auto unit = doubt_about_unit(windows, believed)) return {*unit};
  const bool is_of_all =
      std::all_of(own.begin(), own.end(), [](const Answer& a) { return a.correlation < -clear; });
  if (is_poor || (!of_signs.empty() && !is_of_all)) {
    if (const auto axes = doubt_about_axes(windows, believed.size(), own)) return {*axes};
  }
  if (!of_signs.empty()) return of_signs;
  if (is_poor) return {};  // nothing is clear enough to name a cause
  return warnings_about_constants(own, believed);
}

}  // namespace flinch
