#include "identification/torque_constant_calibration.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "identification/encoder_warnings.h"
#include "identification/pull_warnings.h"
#include "identification/pull_windows.h"
#include "identification/robust_mean.h"
#include "identification/root_mean_square.h"
#include "identification/torque_constant_fit.h"
#include "systems/config/robot_file.h"
#include "systems/foundation/median.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr double least_excitation = 0.03;   // of the largest torque: range of what a rope does to a drive
constexpr std::size_t fewest_windows = 40;  // in which a rope pulls
/// Standard deviation of the scale of a calibrated instrument, assumed: all constants are off by it together.
constexpr double instrument_scale = 1e-3;
constexpr double degree = 3.14159265358979323846 / 180.0;

/// All windows, and what is wrong with parts of the recordings.
struct Pulls {
  std::vector<PullWindow> windows;
  int mountings = 0;
  std::vector<InstrumentMounting> mounting;
  std::vector<std::string> warnings;
};

Pulls pulls_of(const TorqueConstantBelief& belief, const std::vector<PullRecording>& recordings) {
  Pulls pulls;
  std::vector<std::string> problems;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const PullRecording& from = recordings[r];
    std::vector<std::string> warnings;
    try {
      const std::vector<PullWindow> windows = pull_windows(*from.recording, *belief.robot, from.mountings,
                                                           static_cast<int>(r), pulls.mountings, warnings);
      pulls.windows.insert(pulls.windows.end(), windows.begin(), windows.end());
    } catch (const SetupError& error) {
      for (const std::string& problem : error.problems())
        problems.push_back(from.source.file + ": " + problem);
    }
    for (const std::string& warning : warnings) pulls.warnings.push_back(from.source.file + ": " + warning);
    pulls.mountings += static_cast<int>(from.mountings.size());
    pulls.mounting.insert(pulls.mounting.end(), from.mountings.begin(), from.mountings.end());
  }
  throw_if_any(std::move(problems));
  return pulls;
}

bool is_pulled(const PullWindow& window) { return window.force.norm() > 2.0; }

// ---------------------------------------------------------------- what forbids a fit

/// Correlation of what a rope does to the drive `i` with what the current of the drive `j` answers.
double correlation(const std::vector<PullWindow>& windows, const JointVector& constant, int i, int j) {
  double sx = 0.0, sy = 0.0, sxx = 0.0, syy = 0.0, sxy = 0.0, n = 0.0;
  for (const PullWindow& w : windows) {
    const double x = w.projected()[i];
    const double y = w.model_effort[j] - constant[j] * w.current[j];
    sx += x, sy += y, sxx += x * x, syy += y * y, sxy += x * y, n += 1.0;
  }
  const double scale = (sxx - sx * sx / n) * (syy - sy * sy / n);
  return scale > 0.0 ? (sxy - sx * sy / n) / std::sqrt(scale) : 0.0;
}

/// Whether the current of another drive answers the pulls at a drive better than its own.
std::vector<std::string> swapped_drives(const std::vector<PullWindow>& windows, const JointVector& constant) {
  std::vector<std::string> problems;
  for (int i = 0; i < constant.size(); ++i) {
    const double own = correlation(windows, constant, i, i);
    for (int j = 0; j < constant.size(); ++j) {
      const double other = correlation(windows, constant, i, j);
      if (j == i || other < 0.8 || own > other - 0.3) continue;
      problems.push_back(fmt::format(
          "what pulls at drive {} is answered by the current of drive {} (correlation {:.2f}, own "
          "{:.2f}); currents or legs are swapped: check the order of the drives",
          i + 1, j + 1, other, own));
    }
  }
  return problems;
}

void check(const Pulls& pulls, const TorqueConstantBelief& belief, const char* unit) {
  std::vector<std::string> problems;
  const auto pulled =
      static_cast<std::size_t>(std::count_if(pulls.windows.begin(), pulls.windows.end(), is_pulled));
  if (pulled < fewest_windows) {
    problems.push_back(
        fmt::format("the recordings are too short: a rope pulls for {:.1f} s; at least {:.0f} s are needed",
                    0.1 * static_cast<double>(pulled), 0.1 * static_cast<double>(fewest_windows)));
    problems.insert(problems.end(), pulls.warnings.begin(), pulls.warnings.end());
    throw SetupError(problems);
  }
  for (int i = 0; i < belief.constant.size(); ++i) {
    double low = 0.0, high = 0.0;
    for (const PullWindow& window : pulls.windows) {
      const double torque = window.projected()[i];
      low = std::min(low, torque);
      high = std::max(high, torque);
    }
    const double least = least_excitation * belief.drives.max_torque;
    if (high - low >= least) continue;
    problems.push_back(fmt::format(
        "drive {} is not excited: what the rope does to it ranges over {:.2g} {}, and at least {:.2g} {} are "
        "needed; pull harder, at the links of its leg, across them",
        i + 1, high - low, unit, least, unit));
  }
  throw_if_any(std::move(problems));
  throw_if_any(swapped_drives(pulls.windows, belief.constant));
}

// ---------------------------------------------------------------- what is to be doubted

/// Residuals of one mounting under the fit, of all drives.
std::vector<double> residuals_at(const Pulls& pulls, int mounting, int body_instead,
                                 const TorqueConstantFit& fit, const TorqueConstantModel& model) {
  std::vector<double> residuals;
  for (const PullWindow& window : pulls.windows) {
    if (window.mounting != mounting || (body_instead >= 0 && window.body != body_instead)) continue;
    for (int i = 0; i < fit.constant.size(); ++i) {
      if (model.coulomb && std::abs(window.rate[i]) <= model.slow) continue;
      residuals.push_back(torque_residual(window, i, fit, model.slow));
    }
  }
  return residuals;
}

void doubt_mountings(const Pulls& pulls, const TorqueConstantFit& fit, const TorqueConstantModel& model,
                     const TorqueConstantBelief& belief, std::vector<std::string>& warnings) {
  std::vector<double> all;
  for (int m = 0; m < pulls.mountings; ++m) {
    const std::vector<double> residuals = residuals_at(pulls, m, -1, fit, model);
    if (!residuals.empty()) all.push_back(robust_deviation(residuals));
  }
  const double usual = median(all);
  for (int m = 0; m < pulls.mountings; ++m) {
    const std::vector<double> residuals = residuals_at(pulls, m, -1, fit, model);
    if (residuals.empty()) continue;
    const BodyId body = BodyId::from_index(pulls.mounting[static_cast<std::size_t>(m)].body);
    const std::string name = fmt::format("pulls[{}], {}", m, belief.robot->body(body).name);
    const double own = robust_deviation(residuals);
    if (own > 4.0 * usual) {
      warnings.push_back(fmt::format(
          "{}: its residual is {:.2g}, {:.0f} times the usual; the instrument sits elsewhere than "
          "'pulls' says, or on another body or leg. It is hardly used; check body and position",
          name, own, own / usual));
    }
    const double turned = fit.misalignment[static_cast<std::size_t>(m)].norm();
    if (turned > 3.0 * model.misalignment_belief) {
      warnings.push_back(
          fmt::format("{}: the instrument seems to be turned by {:.1f} degrees; check how it is mounted",
                      name, turned / degree));
    }
  }
}

void doubt_outliers(const TorqueConstantFit& fit, std::vector<std::string>& warnings) {
  const double left_out = static_cast<double>((fit.linear.weight.array() < 0.05).count()) /
                          static_cast<double>(fit.linear.weight.size());
  if (left_out < 0.05) return;
  warnings.push_back(fmt::format(
      "{:.0f} % of the windows do not fit the others and are left out; the rope slipped or snapped, or "
      "something else touched the robot",
      100.0 * left_out));
}

// ---------------------------------------------------------------- what is told

TorqueConstantModel model_for(const Pulls& pulls, const TorqueConstantBelief& belief) {
  TorqueConstantModel model;
  model.usual_error = 0.01 * belief.drives.max_torque;
  model.slow = belief.drives.max_speed / 400.0;
  std::vector<double> rates;
  for (const PullWindow& window : pulls.windows) rates.push_back(window.rate.cwiseAbs().maxCoeff());
  model.coulomb = median(rates) > 2.0 * model.slow;  // else it never slips
  return model;
}

void add_parameters(const TorqueConstantFit& fit, const FitUncertainty& sure,
                    const TorqueConstantModel& model, const TorqueConstantBelief& belief,
                    CalibrationResult& result) {
  const bool turns = belief.robot->drive_kind(0) == DriveKind::revolute;
  const char* const effort = turns ? "Nm" : "N";
  std::vector<Eigen::Index> order;
  const auto add = [&](CalibratedParameter parameter, Eigen::Index column) {
    parameter.identifiable = sure.identifiable[static_cast<std::size_t>(column)];
    if (parameter.identifiable) {
      parameter.deviation = sure.deviation[column];
    } else if (parameter.before) {
      parameter.value = *parameter.before;
    }
    result.parameters.push_back(std::move(parameter));
    order.push_back(column);
  };
  for (int i = 0; i < fit.constant.size(); ++i) {
    add({.name = drive_constant_key(*belief.robot, i),
         .value = fit.constant[i],
         .deviation = {},
         .unit = fmt::format("{}/A", effort),
         .before = belief.constant[i],
         .belongs_to = "robot"},
        fit.column_of_drive[static_cast<std::size_t>(i)]);
  }
  for (int i = 0; i < fit.constant.size(); ++i) {
    add({.name = fmt::format("offset[{}]", i),
         .value = fit.offset[i],
         .deviation = {},
         .unit = effort,
         .before = {},
         .belongs_to = ""},
        fit.column_of_drive[static_cast<std::size_t>(i)] + 1);
    if (!model.coulomb) continue;
    add({.name = fmt::format("coulomb_beyond_model[{}]", i),
         .value = fit.coulomb[i],
         .deviation = {},
         .unit = effort,
         .before = {},
         .belongs_to = ""},
        fit.column_of_drive[static_cast<std::size_t>(i)] + 2);
  }
  result.covariance.resize(static_cast<Eigen::Index>(order.size()), static_cast<Eigen::Index>(order.size()));
  result.influence.resize(static_cast<Eigen::Index>(order.size()), sure.influence.cols());
  for (std::size_t a = 0; a < order.size(); ++a) {
    const auto row = static_cast<Eigen::Index>(a);
    result.influence.row(row) = sure.influence.row(order[a]);
    for (std::size_t b = 0; b < order.size(); ++b)
      result.covariance(row, static_cast<Eigen::Index>(b)) = sure.covariance(order[a], order[b]);
  }
  for (Eigen::Index a = 0; a < fit.constant.size(); ++a) {
    for (Eigen::Index b = 0; b < fit.constant.size(); ++b)
      result.covariance(a, b) += instrument_scale * instrument_scale * fit.constant[a] * fit.constant[b];
    CalibratedParameter& constant = result.parameters[static_cast<std::size_t>(a)];
    if (constant.identifiable) constant.deviation = std::sqrt(result.covariance(a, a));
  }
}

/// Before and after, over the current, of each drive.
void add_residuals(const std::vector<PullWindow>& windows, const TorqueConstantFit& fit,
                   const TorqueConstantModel& model, const TorqueConstantBelief& belief,
                   CalibrationResult& result) {
  TorqueConstantFit before = fit;
  before.constant = belief.constant;
  before.offset.setZero();
  before.coulomb.setZero();
  for (PullWave& wave : before.cogging) wave.parts.setZero();
  before.ripple.parts.setZero();
  before.surplus.resize(0);
  for (Eigen::Vector3d& turn : before.misalignment) turn.setZero();
  std::vector<double> old_residuals, residuals;
  for (int i = 0; i < fit.constant.size(); ++i) {
    CalibrationPlot plot{.title = fmt::format("drive {}", i + 1),
                         .x_name = "current",
                         .x_unit = "A",
                         .y_name = "residual",
                         .y_unit = result.residual_unit,
                         .x = {},
                         .before = {},
                         .after = {}};
    for (std::size_t row = 0; row < fit.window_of_row.size(); ++row) {
      const bool left_out = fit.linear.weight[static_cast<Eigen::Index>(row)] < 0.05;
      if (fit.drive_of_row[row] != i || left_out) continue;
      const PullWindow& window = windows[fit.window_of_row[row]];
      plot.x.push_back(window.current[i]);
      plot.before.push_back(torque_residual(window, i, before, model.slow));
      plot.after.push_back(torque_residual(window, i, fit, model.slow));
    }
    old_residuals.insert(old_residuals.end(), plot.before.begin(), plot.before.end());
    residuals.insert(residuals.end(), plot.after.begin(), plot.after.end());
    result.plots.push_back(std::move(plot));
  }
  result.residual_before = root_mean_square(old_residuals);
  result.residual_after = root_mean_square(residuals);
}

/// What repeats along the way of a drive: of one that turns, so many times a turn.
void tell_waves(const TorqueConstantFit& fit, const TorqueConstantBelief& belief, CalibrationResult& result) {
  const char* const per = belief.robot->drive_kind(0) == DriveKind::revolute ? "periods a turn" : "rad/m";
  for (int i = 0; i < fit.constant.size(); ++i) {
    for (const PullWave& wave : fit.cogging) {
      if (!(wave.rate[i] > 0.0)) continue;
      result.notes.push_back(fmt::format("drive {} cogs: {:.2g} {}, {:.0f} {}", i + 1,
                                         wave.parts.col(i).norm(), result.residual_unit, wave.rate[i], per));
    }
    if (fit.ripple.rate[i] > 0.0) {
      result.notes.push_back(fmt::format("drive {} has a ripple of {:.2g} % of its torque, {:.0f} {}", i + 1,
                                         100.0 * fit.ripple.parts.col(i).norm(), fit.ripple.rate[i], per));
    }
  }
}

BoxNumbers box(const std::string& name, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
  };
  return {name, values.front(), at(0.25), at(0.5), at(0.75), values.back()};
}

/// Components of the force by which the wrench from currents misses that of the instrument. [ICRA23] Fig. 4b
void validate(const TorqueConstantBelief& belief, const std::vector<PullRecording>& unseen,
              const JointVector& constant, CalibrationResult& result) {
  if (unseen.empty()) return;
  const Pulls pulls = pulls_of(belief, unseen);
  std::map<int, std::vector<double>> errors;
  for (const PullWindow& window : pulls.windows) {
    if (!is_pulled(window)) continue;
    const JointVector estimated = window.model_effort - constant.cwiseProduct(window.current);
    const PlatformVector error = window.drive_map.transpose() * (estimated - window.projected());
    std::vector<double>& of_body = errors[window.body];
    for (int i = 0; i < belief.robot->space().translations(); ++i) of_body.push_back(error[i]);
  }
  result.validation_unit = "N";
  for (auto& [body, values] : errors) {
    result.validation.push_back(box(belief.robot->body(BodyId::from_index(body)).name, std::move(values)));
  }
}

}  // namespace

CalibrationResult calibrate_torque_constants(const TorqueConstantBelief& belief,
                                             const std::vector<PullRecording>& recordings,
                                             const std::vector<PullRecording>& unseen) {
  CalibrationResult result;
  result.kind = "torque-constant";
  result.residual_unit = belief.robot->drive_kind(0) == DriveKind::revolute ? "Nm" : "N";
  for (const PullRecording& recording : recordings) result.recordings.push_back(recording.source);
  for (const PullRecording& recording : unseen) result.unseen.push_back(recording.source);
  const Pulls pulls = pulls_of(belief, recordings);
  check(pulls, belief, result.residual_unit.c_str());
  result.warnings = pulls.warnings;
  result.contradictions = warnings_about_pulls(pulls.windows, belief.constant);
  add_encoder_warnings(recordings, *belief.robot, result.contradictions);

  const TorqueConstantModel model = model_for(pulls, belief);
  const TorqueConstantFit fit = fit_torque_constants(pulls.windows, pulls.mountings, belief.constant, model);
  const FitUncertainty sure = fit_uncertainty(fit.linear);
  result.rank = sure.rank;
  result.condition = sure.condition;
  add_parameters(fit, sure, model, belief, result);
  add_residuals(pulls.windows, fit, model, belief, result);
  doubt_mountings(pulls, fit, model, belief, result.warnings);
  doubt_outliers(fit, result.warnings);
  tell_waves(fit, belief, result);
  validate(belief, unseen, fit.constant, result);
  return result;
}

}  // namespace flinch
