#include "identification/torque_constant_fit.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "identification/ceres_fit.h"
#include "identification/dominant_wave.h"
#include "identification/robust_mean.h"
#include "systems/foundation/median.h"
#include "systems/robot/rotation.h"

namespace flinch {
namespace {

// k_t, o, c; sine and cosine of each wave of the cogging, then of the ripple; their rates
constexpr int ripple_wave = most_pull_waves, all_waves = most_pull_waves + 1;
constexpr int sine_of(int wave) { return 3 + 2 * wave; }
constexpr int rate_of(int wave) { return 3 + 2 * all_waves + wave; }
constexpr int of_drive_count = 3 + 3 * all_waves;
using DriveUnknowns = std::array<double, of_drive_count>;
using Turn = std::array<double, 3>;  // a rotation vector

constexpr double least_explained = 0.1;  // of the scatter, for a wave to be believed
constexpr double largest_ripple = 0.3;   // of the torque; more is not ripple but another constant
constexpr double least_slope = 0.01;     // of the usual error, for a parameter of the robot to matter
constexpr double alike = 0.95;           // the correlation of what cannot be told apart

/// sgn(rate), smooth.
double direction(double rate, double slow) { return std::tanh(2.0 * rate / slow); }

/// One window at one drive.
struct PullResidual {
  const PullWindow* window;
  int drive;
  double sigma;  ///< of the residual, without the noise of the current [Nm or N]
  double slow;

  /// `surplus`: what the drive must do beyond the model.
  template <class T>
  bool operator()(const T* const of_drive, const T* const turn, const T* const surplus, T* residual) const {
    const PullWindow& w = *window;
    const std::array<T, 3> force = {T(w.force.x()), T(w.force.y()), T(w.force.z())};
    const std::array<T, 3> moment = {T(w.moment.x()), T(w.moment.y()), T(w.moment.z())};
    std::array<T, 3> true_force, true_moment;
    ceres::AngleAxisRotatePoint(turn, force.data(), true_force.data());
    ceres::AngleAxisRotatePoint(turn, moment.data(), true_moment.data());
    T pulled(0.0);
    for (int j = 0; j < 3; ++j) {
      const auto at = static_cast<std::size_t>(j);
      pulled += w.force_map(drive, j) * true_force[at] + w.moment_map(drive, j) * true_moment[at];
    }
    using std::cos, std::sin, std::sqrt;
    const auto wave = [&](int number) {
      if (of_drive[rate_of(number)] == T(0.0)) return T(0.0);
      const T phase = of_drive[rate_of(number)] * w.position[drive];
      return of_drive[sine_of(number)] * sin(phase) + of_drive[sine_of(number) + 1] * cos(phase);
    };
    T cogging(0.0);
    for (int number = 0; number < most_pull_waves; ++number) cogging += wave(number);
    const T uneven = 1.0 + wave(ripple_wave);
    const T effort = of_drive[0] * w.current[drive] * uneven - w.model_effort[drive] - surplus[0] + pulled -
                     of_drive[1] - of_drive[2] * direction(w.rate[drive], slow) - cogging;
    const T of_current = of_drive[0] * w.current_deviation[drive];
    residual[0] = effort / sqrt(sigma * sigma + of_current * of_current);
    return true;
  }
};

/// The same, where what the drive must do beyond the model depends linearly on parameters of the robot.
class RobotPullResidual final : public ceres::CostFunction {
 public:
  RobotPullResidual(const PullResidual& pull, Eigen::RowVectorXd slopes)
      : pull_(new PullResidual(pull)), slopes_(std::move(slopes)) {
    set_num_residuals(1);
    *mutable_parameter_block_sizes() = {of_drive_count, 3};
    if (slopes_.size() > 0) mutable_parameter_block_sizes()->push_back(static_cast<int>(slopes_.size()));
  }

  bool Evaluate(double const* const* blocks, double* residual, double** jacobians) const override {
    const bool robot = slopes_.size() > 0;
    const double surplus =
        robot ? slopes_.dot(Eigen::Map<const Eigen::VectorXd>(blocks[2], slopes_.size())) : 0.0;
    const std::array<const double*, 3> inner = {blocks[0], blocks[1], &surplus};
    double of_surplus = 0.0;
    const bool wanted = jacobians != nullptr && robot && jacobians[2] != nullptr;
    std::array<double*, 3> inner_jacobians = {nullptr, nullptr, wanted ? &of_surplus : nullptr};
    if (jacobians != nullptr) inner_jacobians[0] = jacobians[0], inner_jacobians[1] = jacobians[1];
    if (!pull_.Evaluate(inner.data(), residual, inner_jacobians.data())) return false;
    if (wanted) Eigen::Map<Eigen::RowVectorXd>(jacobians[2], slopes_.size()) = of_surplus * slopes_;
    return true;
  }

 private:
  ceres::AutoDiffCostFunction<PullResidual, 1, of_drive_count, 3, 1> pull_;
  Eigen::RowVectorXd slopes_;
};

/// The dynamic parameters of which pulls can tell something that offset and Coulomb friction of a drive do
/// not tell: those that matter, but not what acts at one drive alone as the sign of its rate does.
std::vector<Eigen::Index> parameters_that_tell(const std::vector<PullWindow>& windows,
                                               const TorqueConstantModel& model) {
  std::vector<Eigen::Index> telling;
  if (windows.empty()) return telling;
  const Eigen::Index drives = windows.front().effort_slopes.rows();
  for (Eigen::Index j = 0; j < windows.front().effort_slopes.cols(); ++j) {
    int acts_on = 0;
    double most_alike = 0.0;
    for (Eigen::Index i = 0; i < drives; ++i) {
      double largest = 0.0, squares = 0.0, signs = 0.0, both = 0.0;
      for (const PullWindow& window : windows) {
        const double slope = window.effort_slopes(i, j);
        const double sign = direction(window.rate[i], model.slow);
        largest = std::max(largest, std::abs(slope));
        squares += slope * slope, signs += sign * sign, both += slope * sign;
      }
      if (largest < least_slope * model.usual_error) continue;
      ++acts_on;
      most_alike = std::max(most_alike, both / std::sqrt(squares * signs));
    }
    if (acts_on > 1 || (acts_on == 1 && most_alike < alike)) telling.push_back(j);
  }
  return telling;
}

/// Everything that is looked for, as Ceres moves it.
struct Unknowns {
  std::vector<DriveUnknowns> drives;
  std::vector<Turn> turns;
};

class Fit {
 public:
  Fit(const std::vector<PullWindow>& windows, int mountings, const JointVector& believed,
      const TorqueConstantModel& model)
      : windows_(windows),
        model_(model),
        sigma_(JointVector::Constant(believed.size(), model.usual_error)),
        waves_(static_cast<std::size_t>(believed.size())) {
    for (const double k : believed) unknowns_.drives.push_back({k});
    unknowns_.turns.assign(static_cast<std::size_t>(mountings), Turn{});
    telling_ = parameters_that_tell(windows, model);
    surplus_.setZero(static_cast<Eigen::Index>(telling_.size()));
    planar_ = !windows.empty() && windows.front().force_map.col(2).isZero(0.0);
  }

  void solve() {
    for (const Loss loss : {Loss::huber, Loss::huber, Loss::huber, Loss::huber, Loss::huber, Loss::tukey,
                            Loss::tukey, Loss::tukey}) {
      solve_once(loss);
      if (model_.cogging && loss == Loss::huber) find_waves();
      rescale();
    }
    solve_once(Loss::tukey);
  }

  TorqueConstantFit take() {
    TorqueConstantFit fit = values();
    fit.linear = linearised(*problem_, blocks_, columns_, Loss::tukey);
    for (const std::size_t w : rows_) {
      fit.linear.cluster.push_back(windows_[w].cluster);
      fit.linear.recording.push_back(windows_[w].recording);
    }
    fit.linear.prior_information = Eigen::VectorXd::Zero(fit.linear.jacobian.cols());
    Eigen::Index of_drives = 0;
    for (int i = 0; i < static_cast<int>(sigma_.size()); ++i) {
      fit.column_of_drive.push_back(of_drives);
      of_drives += of_drive_count - static_cast<Eigen::Index>(held_of(i).size());
      Eigen::Index rate = of_drives;
      for (int number = all_waves - 1; number >= 0; --number) {
        const Wave& wave = waves_[index(i)][index(number)];
        if (wave.rate > 0.0) fit.linear.prior_information[--rate] = 1.0 / (wave.deviation * wave.deviation);
      }
    }
    const double believed = model_.misalignment_belief;
    const Eigen::Index of_turns = fit.linear.jacobian.cols() - of_drives - surplus_.size();
    fit.linear.prior_information.segment(of_drives, of_turns).setConstant(1.0 / (believed * believed));
    fit.linear.prior_information.tail(surplus_.size()).setOnes();
    fit.window_of_row = rows_;
    fit.drive_of_row = drives_of_rows_;
    return fit;
  }

 private:
  bool tells(const PullWindow& window, int drive) const {
    return !model_.coulomb || std::abs(window.rate[drive]) > model_.slow;
  }

  void solve_once(Loss loss) {
    problem_ = std::make_unique<ceres::Problem>();
    blocks_.clear();
    rows_.clear();
    drives_of_rows_.clear();
    for (std::size_t w = 0; w < windows_.size(); ++w) {
      for (int i = 0; i < static_cast<int>(sigma_.size()); ++i) {
        if (!tells(windows_[w], i)) continue;
        std::vector<double*> of_row = {unknowns_.drives[index(i)].data(),
                                       unknowns_.turns[index(windows_[w].mounting)].data()};
        if (!telling_.empty()) of_row.push_back(surplus_.data());
        auto* const cost =
            new RobotPullResidual({&windows_[w], i, sigma_[i], model_.slow}, slopes_of(windows_[w], i));
        blocks_.push_back(problem_->AddResidualBlock(cost, loss_function(loss), of_row));
        rows_.push_back(w);
        drives_of_rows_.push_back(i);
      }
    }
    constrain();
    solve_problem(*problem_);
  }

  Eigen::RowVectorXd slopes_of(const PullWindow& window, int drive) const {
    Eigen::RowVectorXd slopes(surplus_.size());
    for (Eigen::Index k = 0; k < slopes.size(); ++k)
      slopes[k] = window.effort_slopes(drive, telling_[static_cast<std::size_t>(k)]);
    return slopes;
  }

  /// Which unknowns of a drive are not looked for.
  std::vector<int> held_of(int drive) const {
    std::vector<int> held;
    if (!model_.coulomb) held.push_back(2);
    for (int number = 0; number < all_waves; ++number) {
      if (waves_[index(drive)][index(number)].rate > 0.0) continue;
      held.insert(held.end(), {sine_of(number), sine_of(number) + 1, rate_of(number)});
    }
    return held;
  }

  /// The first wave of the cogging of a drive that is not found yet; none: there may be no more.
  std::optional<int> next_wave(int drive) const {
    for (int number = 0; number < most_pull_waves; ++number)
      if (waves_[index(drive)][index(number)].rate == 0.0) return number;
    return std::nullopt;
  }

  /// Whether a wave of a drive's cogging is as fast: what it could not explain is no other one.
  bool is_known(int drive, const Wave& wave) const {
    return std::any_of(waves_[index(drive)].begin(), waves_[index(drive)].begin() + most_pull_waves,
                       [&](const Wave& known) { return std::abs(known.rate - wave.rate) < wave.least; });
  }

  /// Looks in what is left for what repeats along the way, by itself or times the torque, and takes what
  /// explains more.
  void find_waves() {
    const TorqueConstantFit fit = values();
    for (int i = 0; i < static_cast<int>(sigma_.size()); ++i) {
      std::vector<WaveSample> cogging, ripple;
      for (const PullWindow& window : windows_) {
        if (!tells(window, i) || window.position.size() == 0) continue;
        const double left = torque_residual(window, i, fit, model_.slow);
        if (std::abs(left) > 4.0 * sigma_[i]) continue;
        cogging.push_back({.position = window.position[i], .left = left});
        ripple.push_back(
            {.position = window.position[i], .factor = fit.constant[i] * window.current[i], .left = left});
      }
      const std::optional<int> next = next_wave(i);
      Wave cogs = next ? dominant_wave(cogging, 0.5, least_explained) : Wave();
      if (is_known(i, cogs)) cogs = Wave();
      Wave& found_ripple = waves_[index(i)][index(ripple_wave)];
      const Wave ripples = found_ripple.rate > 0.0 ? Wave() : dominant_wave(ripple, 1.0, least_explained);
      DriveUnknowns& unknowns = unknowns_.drives[index(i)];
      if (cogs.explained > ripples.explained) {
        waves_[index(i)][index(*next)] = cogs, unknowns[index(rate_of(*next))] = cogs.rate;
      } else if (ripples.explained > 0.0) {
        found_ripple = ripples, unknowns[index(rate_of(ripple_wave))] = ripples.rate;
      }
    }
  }

  void constrain() {
    columns_.clear();
    for (DriveUnknowns& drive : unknowns_.drives) {
      if (!problem_->HasParameterBlock(drive.data())) continue;
      columns_.push_back(drive.data());
      problem_->SetParameterLowerBound(drive.data(), 0, 1e-9);
      for (const int part : {sine_of(ripple_wave), sine_of(ripple_wave) + 1}) {
        problem_->SetParameterLowerBound(drive.data(), part, -largest_ripple);
        problem_->SetParameterUpperBound(drive.data(), part, largest_ripple);
      }
      const int i = static_cast<int>(&drive - unknowns_.drives.data());
      const std::vector<int> held = held_of(i);
      if (!held.empty()) problem_->SetManifold(drive.data(), new ceres::SubsetManifold(of_drive_count, held));
      for (int number = 0; number < all_waves; ++number)
        believe_rate(drive, rate_of(number), waves_[index(i)][index(number)]);
    }
    for (Turn& turn : unknowns_.turns) {
      if (!problem_->HasParameterBlock(turn.data())) continue;
      if (!model_.misalignment) {
        problem_->SetParameterBlockConstant(turn.data());
        continue;
      }
      columns_.push_back(turn.data());
      if (planar_) problem_->SetManifold(turn.data(), new ceres::SubsetManifold(3, {0, 1}));
      add_belief(*problem_, turn.data(), Eigen::Vector3d::Zero(),
                 Eigen::Vector3d::Constant(model_.misalignment_belief));
    }
    if (telling_.empty()) return;
    columns_.push_back(surplus_.data());
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(surplus_.size());
    add_belief(*problem_, surplus_.data(), 0.0 * one, one);
  }

  /// The rate of a wave is that at which it was found, to within half a wave over the way.
  void believe_rate(DriveUnknowns& drive, int entry, const Wave& wave) {
    if (wave.rate == 0.0) return;
    Eigen::RowVectorXd of_entry = Eigen::RowVectorXd::Zero(of_drive_count);
    of_entry[entry] = 1.0 / wave.deviation;
    problem_->SetParameterLowerBound(drive.data(), entry, wave.least);
    problem_->AddResidualBlock(
        new ceres::NormalPrior(of_entry, wave.rate * Eigen::VectorXd::Unit(of_drive_count, entry)), nullptr,
        drive.data());
  }

  /// sigma_i of the residuals, without what the noise of the current explains.
  void rescale() {
    const TorqueConstantFit fit = values();
    for (int i = 0; i < static_cast<int>(sigma_.size()); ++i) {
      std::vector<double> residuals, of_current;
      for (const PullWindow& window : windows_) {
        if (!tells(window, i)) continue;
        residuals.push_back(torque_residual(window, i, fit, model_.slow));
        of_current.push_back(fit.constant[i] * window.current_deviation[i]);
      }
      if (residuals.empty()) continue;
      const double all = robust_deviation(residuals);
      const double known = median(of_current);
      const double least = 0.1 * known + 1e-6 * model_.usual_error;
      sigma_[i] = std::sqrt(std::max(all * all - known * known, least * least));
    }
  }

  PullWave wave_of(int number) const {
    const auto n = static_cast<Eigen::Index>(unknowns_.drives.size());
    PullWave wave{JointVector(n), {}};
    wave.parts.resize(2, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const DriveUnknowns& drive = unknowns_.drives[static_cast<std::size_t>(i)];
      wave.rate[i] = drive[index(rate_of(number))];
      wave.parts.col(i) << drive[index(sine_of(number))], drive[index(sine_of(number) + 1)];
    }
    return wave;
  }

  TorqueConstantFit values() const {
    TorqueConstantFit fit;
    const auto n = static_cast<Eigen::Index>(unknowns_.drives.size());
    fit.constant.resize(n);
    fit.offset.resize(n);
    fit.coulomb.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const DriveUnknowns& drive = unknowns_.drives[static_cast<std::size_t>(i)];
      fit.constant[i] = drive[0];
      fit.offset[i] = drive[1];
      fit.coulomb[i] = drive[2];
    }
    for (int number = 0; number < most_pull_waves; ++number) fit.cogging[index(number)] = wave_of(number);
    fit.ripple = wave_of(ripple_wave);
    for (const Turn& turn : unknowns_.turns) fit.misalignment.emplace_back(turn[0], turn[1], turn[2]);
    if (!telling_.empty()) fit.surplus.setZero(windows_.front().effort_slopes.cols());
    for (Eigen::Index k = 0; k < surplus_.size(); ++k)
      fit.surplus[telling_[static_cast<std::size_t>(k)]] = surplus_[k];
    fit.deviation = sigma_;
    return fit;
  }

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  const std::vector<PullWindow>& windows_;
  TorqueConstantModel model_;
  JointVector sigma_;
  std::vector<std::array<Wave, all_waves>> waves_;  ///< by drive, as they were found; rate 0: none
  bool planar_ = false;
  std::vector<Eigen::Index> telling_;  ///< dynamic parameters that are looked for
  Eigen::VectorXd surplus_;            ///< theirs
  Unknowns unknowns_;
  std::unique_ptr<ceres::Problem> problem_;
  std::vector<ceres::ResidualBlockId> blocks_;
  std::vector<double*> columns_;
  std::vector<std::size_t> rows_;
  std::vector<int> drives_of_rows_;
};

}  // namespace

TorqueConstantFit fit_torque_constants(const std::vector<PullWindow>& windows, int mountings,
                                       const JointVector& believed, const TorqueConstantModel& model) {
  Fit fit(windows, mountings, believed, model);
  fit.solve();
  return fit.take();
}

double PullWave::at(int drive, double position) const {
  if (!(rate[drive] > 0.0)) return 0.0;
  const double phase = rate[drive] * position;
  return parts(0, drive) * std::sin(phase) + parts(1, drive) * std::cos(phase);
}

double torque_residual(const PullWindow& window, int drive, const TorqueConstantFit& fit, double slow) {
  const Eigen::Vector3d& turn = fit.misalignment[static_cast<std::size_t>(window.mounting)];
  const Eigen::Matrix3d R = rotation_matrix(quaternion_exp(turn));
  const double position = window.position.size() > drive ? window.position[drive] : 0.0;
  double cogging = 0.0;
  for (const PullWave& wave : fit.cogging) cogging += wave.at(drive, position);
  const double uneven = 1.0 + fit.ripple.at(drive, position);
  const double pulled =
      window.force_map.row(drive).dot(R * window.force) + window.moment_map.row(drive).dot(R * window.moment);
  const double model = window.model_effort[drive] +
                       (fit.surplus.size() > 0 ? window.effort_slopes.row(drive).dot(fit.surplus) : 0.0);
  return fit.constant[drive] * window.current[drive] * uneven - model + pulled - fit.offset[drive] -
         fit.coulomb[drive] * direction(window.rate[drive], slow) - cogging;
}

}  // namespace flinch
