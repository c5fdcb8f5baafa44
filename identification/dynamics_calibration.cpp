#include "identification/dynamics_calibration.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include "experiments/verdict/recorded_run.h"
#include "identification/constant_torques.h"
#include "identification/dynamics_fit.h"
#include "identification/dynamics_rows.h"
#include "identification/encoder_warnings.h"
#include "identification/left_torque_warnings.h"
#include "identification/motion_warnings.h"
#include "identification/motor_parameters.h"
#include "identification/physical_parameters.h"
#include "identification/root_mean_square.h"
#include "systems/config/robot_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/dynamic_parameters.h"

namespace flinch {
namespace {

constexpr double least_excitation = 0.01;  // of the largest torque: range of a drive's torque
constexpr double poor = 0.2;               // of the torque's deviation: what is left of it after the fit
constexpr double usual_loss = 0.1;         // of the largest torque of a drive: friction
constexpr double worth_telling = 0.1;      // of what is left of a drive's torque: what a wave of it explains

/// Throws SetupError where something touched the robot.
void refuse_contact(const Recording& recording, const ParallelRobot& robot) {
  if (recording.find("truth") == nullptr) return;  // nobody knows
  const RecordedRun run(recording, robot.space());
  for (std::size_t k = 0; k < run.size(); ++k) {
    if (run[k].is_touched()) {
      throw SetupError(
          fmt::format("something touched or pushed the robot at {:.3f} s; dynamics come from motion "
                      "without contact",
                      run[k].time));
    }
  }
}

DynamicsRows rows_of(const DynamicsBelief& belief, const DynamicParameters& parameters,
                     const std::vector<MotionRecording>& recordings, std::vector<std::string>& warnings) {
  DynamicsRows rows;
  std::vector<std::string> problems;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    std::vector<std::string> own;
    const std::string& file = recordings[r].source.file;
    try {
      refuse_contact(*recordings[r].recording, *belief.robot);
      const TorqueBelief torques{belief.constant, belief.drives.torque_delay, belief.control_period};
      rows.append(dynamics_rows(*recordings[r].recording, *belief.robot, parameters, torques,
                                static_cast<int>(r), own));
    } catch (const SetupError& error) {
      for (const std::string& problem : error.problems()) problems.push_back(file + ": " + problem);
    }
    for (const std::string& warning : own) warnings.push_back(file + ": " + warning);
  }
  throw_if_any(std::move(problems));
  return rows;
}

double spread(const Eigen::VectorXd& x) {
  return x.size() == 0 ? 0.0 : std::sqrt((x.array() - x.mean()).square().mean());
}

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const double scale = spread(a) * spread(b);
  return scale > 0.0 ? ((a.array() - a.mean()) * (b.array() - b.mean())).mean() / scale : 0.0;
}

/// Of the numbers `a` of the drive `i` with the numbers `b` of the drive `j`, at the times that both have.
double correlation_of_drives(const DynamicsRows& rows, const Eigen::VectorXd& a, int i,
                             const Eigen::VectorXd& b, int j) {
  std::map<std::pair<int, double>, double> of_j;
  for (Eigen::Index row = 0; row < b.size(); ++row) {
    const auto at = static_cast<std::size_t>(row);
    if (rows.drive[at] == j) of_j[{rows.recording[at], rows.time[at]}] = b[row];
  }
  std::vector<double> x, y;
  for (Eigen::Index row = 0; row < a.size(); ++row) {
    const auto at = static_cast<std::size_t>(row);
    if (rows.drive[at] != i) continue;
    const auto match = of_j.find({rows.recording[at], rows.time[at]});
    if (match == of_j.end()) continue;
    x.push_back(a[row]);
    y.push_back(match->second);
  }
  const auto n = static_cast<Eigen::Index>(x.size());
  return correlation(Eigen::Map<Eigen::VectorXd>(x.data(), n), Eigen::Map<Eigen::VectorXd>(y.data(), n));
}

void check(const DynamicsBelief& belief, const DynamicsRows& rows, const char* unit,
           const std::vector<std::string>& warnings) {
  std::vector<std::string> problems;
  const int drives = belief.robot->drives();
  for (int i = 0; i < drives; ++i) {
    const double seconds = 0.01 * static_cast<double>(std::count(rows.drive.begin(), rows.drive.end(), i));
    if (seconds >= 4.0) continue;
    problems.push_back(
        fmt::format("the recordings are too short: {:.1f} s of motion with a usable current of drive {}; at "
                    "least 4 s are needed, 20 s are good",
                    seconds, i + 1));
  }
  if (!problems.empty()) {
    problems.insert(problems.end(), warnings.begin(), warnings.end());
    throw SetupError(problems);
  }
  for (int i = 0; i < drives; ++i) {
    const Eigen::VectorXd torque = of_drive(rows, rows.torque, i);
    const double range = torque.maxCoeff() - torque.minCoeff();
    const double least = least_excitation * belief.drives.max_torque;
    if (range >= least) continue;
    problems.push_back(
        fmt::format("drive {} is not excited: its torque ranges over {:.2g} {}, and at least {:.2g} {} are "
                    "needed; record a "
                    "motion that flinch excite designs",
                    i + 1, range, unit, least, unit));
  }
  throw_if_any(problems);
  // Legs or currents that are swapped answer another drive's model better than their own.
  const Eigen::VectorXd modelled = rows.torque - rows.surplus;
  for (int i = 0; i < drives; ++i) {
    const double own = correlation_of_drives(rows, modelled, i, rows.torque, i);
    for (int j = 0; j < drives; ++j) {
      const double other = correlation_of_drives(rows, modelled, i, rows.torque, j);
      if (j == i || other < 0.8 || own > other - 0.3) continue;
      problems.push_back(
          fmt::format("what drive {} should do is what the current of drive {} does (correlation {:.2f}, own "
                      "{:.2f}); currents or legs are swapped: check the order of the drives",
                      i + 1, j + 1, other, own));
    }
  }
  throw_if_any(std::move(problems));
}

/// Throws SetupError where currents and encoders cannot be of the same time.
void refuse_late_torques(const JointVector& delay) {
  std::vector<std::string> problems;
  for (Eigen::Index i = 0; i < delay.size(); ++i) {
    if (std::abs(delay[i]) <= longest_torque_delay) continue;
    problems.push_back(fmt::format(
        "the torque of drive {} seems to be {:.2f} ms {} its current; more than {:.0f} ms cannot "
        "be: check the times at which currents and encoders are read",
        i + 1, 1e3 * std::abs(delay[i]), delay[i] > 0.0 ? "behind" : "ahead of", 1e3 * longest_torque_delay));
  }
  throw_if_any(std::move(problems));
}

struct Solution {
  DynamicsFit fit;
  FitUncertainty sure;
  std::vector<bool> held;
  double brought_back = 0.0;  ///< largest change of a parameter that physics asked for, in its deviations
};

/// Where no robot can have these parameters, takes those of the robot that explains the rows best, with
/// offsets that fit them.
void make_physical(const DynamicParameters& parameters, Solution& solution) {
  Eigen::VectorXd& values = solution.fit.values;
  if (is_physical(parameters, values)) return;
  const LinearFit& linear = solution.fit.linear;
  const Eigen::Index p = values.size(), offsets = solution.fit.offset.size();
  Eigen::MatrixXd H = linear.jacobian.transpose() * linear.weight.asDiagonal() * linear.jacobian;
  H += linear.prior_information.asDiagonal();
  const Eigen::MatrixXd offsets_follow =
      -H.bottomRightCorner(offsets, offsets).ldlt().solve(H.bottomLeftCorner(offsets, p));
  const Eigen::MatrixXd information = H.topLeftCorner(p, p) + H.topRightCorner(p, offsets) * offsets_follow;
  const Eigen::VectorXd change = nearest_physical(parameters, values, information) - values;
  values += change;
  solution.fit.offset += offsets_follow * change;
  for (Eigen::Index j = 0; j < p; ++j) {
    if (solution.held[static_cast<std::size_t>(j)]) continue;
    solution.brought_back = std::max(solution.brought_back, std::abs(change[j]) / solution.sure.deviation[j]);
  }
}

/// Friction is believed to take a tenth of what a drive has, whatever a mechanism's own kind usually has.
std::vector<DynamicParameter> as_drives_allow(std::vector<DynamicParameter> list,
                                              const DriveParameters& drives) {
  for (DynamicParameter& parameter : list) {
    double most = std::numeric_limits<double>::infinity();
    if (parameter.loss == DriveLoss::coulomb) most = usual_loss * drives.max_torque;
    if (parameter.loss == DriveLoss::viscous) most = usual_loss * drives.max_torque / drives.max_speed;
    parameter.deviation = std::min(parameter.deviation, most);
  }
  return list;
}

/// What the data do not tell is held as believed, and the rest found again.
Solution solve(const DynamicsRows& rows, const DynamicParameters& parameters, const DriveParameters& drives,
               double usual_error) {
  Solution solution;
  const std::vector<DynamicParameter> list = as_drives_allow(parameters.list(), drives);
  const auto p = list.size();
  solution.held.assign(p, false);
  const auto again = [&] {
    solution.fit =
        fit_dynamics(rows, list, static_cast<int>(drives.torque_constant.size()), usual_error, solution.held);
    solution.sure = fit_uncertainty(solution.fit.linear);
  };
  again();
  for (std::size_t j = 0; j < p; ++j) solution.held[j] = !solution.sure.identifiable[j];
  again();
  make_physical(parameters, solution);
  return solution;
}

/// What of the surplus a fit does not explain.
Eigen::VectorXd left_of(const DynamicsRows& rows, const DynamicParameters& parameters,
                        const DynamicsFit& fit) {
  Eigen::VectorXd left = rows.surplus - rows.regressor * (fit.values - parameters.believed());
  for (Eigen::Index row = 0; row < left.size(); ++row) left[row] -= fit.offset_of(rows, row);
  return left;
}

void add_parameters(const MotorParameters& parameters, const Solution& solution, CalibrationResult& result) {
  const std::vector<FileValue> now = parameters.in_file(solution.fit.values);
  const std::vector<FileValue> before = parameters.believed_in_file();
  const auto p = static_cast<Eigen::Index>(parameters.list().size());
  const auto n = static_cast<Eigen::Index>(now.size());
  Eigen::MatrixXd map(n, p);  // of parameters to what the file says
  for (Eigen::Index j = 0; j < p; ++j) {
    const double h = 1e-6 * parameters.list()[static_cast<std::size_t>(j)].deviation;
    Eigen::VectorXd moved = solution.fit.values;
    moved[j] += h;
    const std::vector<FileValue> there = parameters.in_file(moved);
    for (std::size_t i = 0; i < now.size(); ++i)
      map(static_cast<Eigen::Index>(i), j) = (there[i].value - now[i].value) / h;
  }
  result.covariance = map * solution.sure.covariance.topLeftCorner(p, p) * map.transpose();
  result.influence = map * solution.sure.influence.topRows(p);
  // A file takes over delays and cogging of all drives or of none.
  const auto& all = solution.held;
  const auto first_delay = all.begin() + parameters.first_delay();
  const auto first_of_waves = all.begin() + parameters.first_of_waves();
  const bool delays_held = std::all_of(first_delay, first_of_waves, std::identity());
  const bool wave_held = std::any_of(first_of_waves, all.end(), std::identity());
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const std::vector<int>& mainly = now[i].mainly;
    const bool is_delay = !mainly.empty() && mainly.front() >= parameters.first_delay();
    const bool held =
        mainly.empty() ? wave_held : std::all_of(mainly.begin(), mainly.end(), [&](int parameter) {
          return all[static_cast<std::size_t>(parameter)];
        });
    const double variance = result.covariance(row, row);
    result.parameters.push_back(
        {.name = now[i].name,
         .value = now[i].value,
         .deviation = held || !(variance > 0.0) ? std::nullopt : std::optional(std::sqrt(variance)),
         .unit = now[i].unit,
         .identifiable = is_delay ? !delays_held : !held,
         .before = i < before.size() ? std::optional(before[i].value) : std::nullopt,
         .belongs_to = "robot"});
  }
}

void add_residuals(const DynamicsRows& rows, const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                   const LinearFit& linear, int drives, CalibrationResult& result) {
  std::vector<double> old_kept, kept;
  for (int i = 0; i < drives; ++i) {
    CalibrationPlot plot{.title = fmt::format("drive {}", i + 1),
                         .x_name = "time",
                         .x_unit = "s",
                         .y_name = "residual torque",
                         .y_unit = result.residual_unit,
                         .x = {},
                         .before = {},
                         .after = {}};
    for (Eigen::Index row = 0; row < after.size(); ++row) {
      if (rows.drive[static_cast<std::size_t>(row)] != i || linear.weight[row] < 0.05) continue;
      plot.x.push_back(rows.time[static_cast<std::size_t>(row)]);
      plot.before.push_back(before[row]);
      plot.after.push_back(after[row]);
    }
    old_kept.insert(old_kept.end(), plot.before.begin(), plot.before.end());
    kept.insert(kept.end(), plot.after.begin(), plot.after.end());
    result.plots.push_back(std::move(plot));
  }
  result.residual_before = root_mean_square(old_kept);
  result.residual_after = root_mean_square(kept);
}

/// Errors of the torque that the model predicts, before and after.
void validate(const DynamicsBelief& belief, const DynamicParameters& robot, const MotorParameters& parameters,
              const Eigen::VectorXd& values, const std::vector<MotionRecording>& unseen,
              CalibrationResult& result) {
  if (unseen.empty()) return;
  const DynamicsRows rows = parameters.rows(rows_of(belief, robot, unseen, result.warnings));
  const Eigen::VectorXd error = rows.surplus - rows.regressor * (values - parameters.believed());
  const double torque = root_mean_square(rows.torque);
  const double left = root_mean_square(error);
  const double beyond = std::sqrt(std::max(0.0, left * left - rows.noise * rows.noise));
  result.notes.push_back(
      fmt::format("on motion that was not used the predicted torque errs by {:.3g} {} (RMS), {:.2f} % of the "
                  "torque beyond the "
                  "noise of the current; with the believed parameters by {:.3g} {}",
                  left, result.residual_unit, 100.0 * beyond / torque,
                  root_mean_square(without_cogging(rows, belief.drives.cogging)), result.residual_unit));
  const Eigen::VectorXd varying = without_constants(rows, error);
  std::string by_drive;
  for (int i = 0; i < belief.robot->drives(); ++i)
    by_drive += fmt::format("{}{:.3g}", i > 0 ? ", " : "", root_mean_square(of_drive(rows, varying, i)));
  result.notes.push_back(
      fmt::format("apart from what is constant in a recording it errs by {} {} at the drives, with the "
                  "believed parameters by {:.3g}",
                  by_drive, result.residual_unit,
                  root_mean_square(without_constants(rows, without_cogging(rows, belief.drives.cogging)))));
  result.validation_unit = result.residual_unit;
  for (int i = 0; i < belief.robot->drives(); ++i) {
    const Eigen::VectorXd own = of_drive(rows, error, i);
    std::vector<double> sorted(own.begin(), own.end());
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double share) {
      return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
    };
    result.validation.push_back(
        {fmt::format("drive {}", i + 1), sorted.front(), at(0.25), at(0.5), at(0.75), sorted.back()});
  }
}

/// What repeats along the way of a drive after the fit is neither cogging nor noise.
void warn_of_waves(const std::vector<DriveWave>& waves, bool turns, CalibrationResult& result) {
  for (const DriveWave& wave : waves) {
    const std::string every = turns ? fmt::format("{:.1f} times a turn", wave.rate)
                                    : fmt::format("every {:.3g} mm", 2e3 * std::numbers::pi / wave.rate);
    result.warnings.push_back(
        fmt::format("drive {}: a torque of {:.2g} {} that repeats {} is left; it depends on more than where "
                    "the drive is, as torque ripple and errors of an encoder do",
                    wave.drive + 1, std::hypot(wave.sine, wave.cosine), result.residual_unit, every));
  }
}

void doubt(const DynamicsRows& rows, const Solution& solution, const Eigen::VectorXd& after,
           CalibrationResult& result) {
  const double left_out = static_cast<double>((solution.fit.linear.weight.array() < 0.05).count()) /
                          static_cast<double>(after.size());
  if (left_out > 0.1) {
    result.warnings.push_back(fmt::format(
        "{:.0f} % of the samples do not fit the others and are left out; something touched the robot, "
        "or readings are spoilt",
        100.0 * left_out));
  }
  if (result.residual_after > poor * spread(rows.torque)) {
    result.warnings.push_back(
        "the model explains the torques badly: torque constants, geometry or the order of the legs may be "
        "wrong");
  }
  if (solution.brought_back > 0.0) {
    result.warnings.push_back(
        fmt::format("no robot can have the masses and moments that explain the motion best; those of the "
                    "nearest that can exist are taken, up to {:.2g} deviations away{}",
                    solution.brought_back,
                    solution.brought_back > 3.0 ? ": torque constants or the geometry may be wrong"
                                                : "; a richer motion would tell them better"));
  }
}

std::vector<std::string> files_of(const std::vector<MotionRecording>& recordings) {
  std::vector<std::string> files;
  for (const MotionRecording& recording : recordings) files.push_back(recording.source.file);
  return files;
}

void doubt_left_torque(const DynamicsRows& rows, const Eigen::VectorXd& left,
                       const std::vector<MotionRecording>& recordings, CalibrationResult& result) {
  const std::vector<std::string> files = files_of(recordings);
  for (const std::string& warning : warnings_about_contacts(rows, left, files, result.residual_unit))
    result.contradictions.push_back(warning);
  for (const std::string& warning : warnings_about_drift(rows, left, files, result.residual_unit))
    result.warnings.push_back(warning);
}

}  // namespace

CalibrationResult calibrate_dynamics(const DynamicsBelief& belief,
                                     const std::vector<MotionRecording>& recordings,
                                     const std::vector<MotionRecording>& unseen) {
  CalibrationResult result;
  result.kind = "dynamics";
  const bool turns = belief.robot->drive_kind(0) == DriveKind::revolute;
  result.residual_unit = turns ? "Nm" : "N";
  for (const MotionRecording& recording : recordings) result.recordings.push_back(recording.source);
  for (const MotionRecording& recording : unseen) result.unseen.push_back(recording.source);
  const auto of_robot = DynamicParameters::of(*belief.robot);
  DynamicsRows rows = rows_of(belief, *of_robot, recordings, result.warnings);
  check(belief, rows, result.residual_unit.c_str(), result.warnings);
  result.contradictions = warnings_about_motion(rows, belief.robot->drives());
  add_encoder_warnings(recordings, *belief.robot, result.contradictions);
  for (const MotionRecording& recording : recordings) {
    for (const std::string& warning : warnings_about_turns(*recording.recording, *belief.robot))
      result.warnings.push_back(recording.source.file + ": " + warning);
  }

  const int drives = belief.robot->drives();
  const double usual_error = 0.01 * belief.drives.max_torque;
  Solution solution = solve(rows, *of_robot, belief.drives, usual_error);
  const MotorParameters parameters(*of_robot,
                                   find_cogging(rows, left_of(rows, *of_robot, solution.fit), drives),
                                   belief.robot->drive_kind(0), belief.drives);
  rows = parameters.rows(std::move(rows));
  solution = solve(rows, parameters, belief.drives, usual_error);
  refuse_late_torques(parameters.torque_delay(solution.fit.values));
  result.rank = solution.sure.rank;
  result.condition = solution.sure.condition;
  add_parameters(parameters, solution, result);
  const Eigen::VectorXd after = left_of(rows, parameters, solution.fit);
  add_residuals(rows, without_cogging(rows, belief.drives.cogging), after, solution.fit.linear, drives,
                result);
  for (const std::string& note :
       notes_about_constants(files_of(recordings), solution.fit, result.residual_unit))
    result.notes.push_back(note);
  doubt(rows, solution, after, result);
  doubt_left_torque(rows, after, recordings, result);
  if (result.contradictions.empty())
    result.contradictions = warnings_about_values(parameters, solution.fit.values, solution.held);
  for (const int drive : parameters.stilled()) {
    result.warnings.push_back(fmt::format(
        "drive {} was believed to cog, and this motion does not show it, so it is taken back; where "
        "the motor is still the same one, record a wider or slower motion",
        drive + 1));
  }
  warn_of_waves(find_cogging(rows, after, drives, worth_telling), turns, result);
  validate(belief, *of_robot, parameters, solution.fit.values, unseen, result);
  for (int i = 0; i < drives; ++i) {
    result.assumed.push_back({.name = drive_constant_key(*belief.robot, i),
                              .value = belief.constant[i],
                              .unit = turns ? "Nm/A" : "N/A"});
  }
  const Eigen::Index columns = solution.fit.linear.jacobian.cols();
  result.notes.push_back(
      result.rank == columns
          ? fmt::format("rank {} of {}, condition {:.3g}", result.rank, columns, result.condition)
          : fmt::format("rank {} of {}: what this motion does not tell apart follows from what was believed",
                        result.rank, columns));
  return result;
}

}  // namespace flinch
