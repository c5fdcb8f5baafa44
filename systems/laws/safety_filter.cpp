#include "systems/laws/safety_filter.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

constexpr double slack_price = 1e4;  // above every multiplier: the slack is used where nothing else is left
constexpr double share_of_torque_rate = 0.75;  // that a_2 may ask for
constexpr double smallest_reach = 1e-3;        // share of the reach along a direction
constexpr double slowest_direction = 0.1;      // share of a speed limit below which it cannot bind

/// How the platform accelerates under torques: dv = G tau + dv_0.
struct Motion {
  PlatformMatrix G;
  PlatformVector dv_0;
  bool valid = false;
};

Motion motion_of(const Kinematics& at, const Dynamics& model, const WrenchEstimate& pushed) {
  Motion motion;
  if (!at.valid || !model.valid) return motion;
  const Eigen::LLT<PlatformMatrix> cholesky(model.M_x);
  if (cholesky.info() != Eigen::Success) return motion;
  motion.G = cholesky.solve(at.J_qa_x.transpose());
  PlatformVector wrench = -(model.C_x * at.velocity + model.g_x + model.F_fr_x);
  if (pushed.valid && pushed.wrench_in_base.size() == wrench.size()) wrench += pushed.wrench_in_base;
  motion.dv_0 = cholesky.solve(wrench);
  motion.valid = motion.G.allFinite() && motion.dv_0.allFinite();
  return motion;
}

/// What torques may be after those of the tick before.
struct TorqueRange {
  JointVector least, most;
};

TorqueRange range_after(const TorqueCommand& before, Time now, int drives,
                        const SafetyFilterSettings& settings) {
  const JointVector whole = JointVector::Constant(drives, settings.max_torque);
  const bool is_usable = before.valid && before.torque.size() == drives && before.torque.allFinite();
  if (!is_usable) return {-whole, whole};
  const JointVector from = before.torque.cwiseMin(whole).cwiseMax(-whole);
  const double change = settings.max_torque_rate * to_seconds(now - before.computed);
  return {(from.array() - change).matrix().cwiseMax(-whole),
          (from.array() + change).matrix().cwiseMin(whole)};
}

/// The programme in z = (tau / largest torque, slack), row by row.
class Programme {
 public:
  Programme(const SafetyFilterSettings& settings, const Kinematics& at, const Motion& motion,
            const TorqueRange& range)
      : settings_(settings),
        at_(at),
        motion_(motion),
        range_(range),
        drives_(static_cast<int>(motion.G.cols())) {
    programme_.C.resize(max_constraints, drives_ + 1);
    programme_.d.resize(max_constraints);
    usual_reach_ = reach_of(by_torque(PlatformVector::Unit(motion.G.rows(), 0)));
  }

  /// gradient^T dv >= least, softened by the slack; both count as shares of what the drives can do.
  void accelerate(const PlatformVector& gradient, double least, std::uint32_t name) {
    accelerate(gradient, by_torque(gradient), least, name);
  }
  void accelerate(const PlatformVector& gradient, const JointVector& by_torque, double least,
                  std::uint32_t name) {
    const double reach = reach_of(by_torque);
    if (reach < smallest_reach * usual_reach_) return;  // the drives can do nothing about it here
    auto row = programme_.C.row(rows_);
    row.head(drives_) = settings_.max_torque / reach * by_torque.transpose();
    row[drives_] = 1.0;
    programme_.d[rows_] = (least - gradient.dot(motion_.dv_0)) / reach;
    names_[static_cast<std::size_t>(rows_++)] = name;
  }

  /// Where h is flat, it is steeper on the way to its limit: there the drives can do what they usually do.
  /// Who was pushed too fast for the usual braking brakes as hard as they can, and as the limit needs.
  void add_barrier(const Barrier& barrier, double excess) {
    const double h = barrier.room + excess;
    const double dh = barrier.gradient.dot(at_.velocity);
    const JointVector along = by_torque(barrier.gradient);
    const double reach = std::max(reach_of(along), usual_reach_);
    const BrakingShares& braking = settings_.braking;
    const double usual = acceleration_for(barrier, h, dh, braking.of(barrier.kind) * reach);
    const double possible = most_of(along) + barrier.gradient.dot(motion_.dv_0);
    double least = usual;
    if (usual > possible)
      least = std::min(usual, std::max(possible, acceleration_for(barrier, h, dh, braking.hardest * reach)));
    accelerate(barrier.gradient, along, least, 1U << static_cast<unsigned>(barrier.kind));
  }

  void add_speeds() {
    if (std::isfinite(settings_.max_platform_speed)) {
      PlatformVector direction = at_.velocity;
      direction.tail(direction.size() - at_.legs[0].base_joint.size()).setZero();
      const double speed = direction.norm();
      if (speed > slowest_direction * settings_.max_platform_speed) {
        accelerate(-direction / speed, -settings_.speed_rate * (settings_.max_platform_speed - speed),
                   LimitStatus::platform_speed);
      }
    }
    if (!std::isfinite(settings_.max_drive_speed)) return;
    const PlatformVector drift = at_.dJ_qa_x * at_.velocity;
    for (int i = 0; i < drives_; ++i) {
      const double rate = at_.rates.active[i];
      if (std::abs(rate) < slowest_direction * settings_.max_drive_speed) continue;
      const double sign = rate > 0.0 ? 1.0 : -1.0;
      const double room = settings_.max_drive_speed - std::abs(rate);
      accelerate(-sign * at_.J_qa_x.row(i).transpose(), sign * drift[i] - settings_.speed_rate * room,
                 LimitStatus::drive_speed);
    }
  }

  /// Torques within their range, which leaves no slack, and a slack that is not negative.
  void add_bounds() {
    for (int i = 0; i < drives_; ++i) {
      bound(i, 1.0, range_.least[i] / settings_.max_torque);
      bound(i, -1.0, -range_.most[i] / settings_.max_torque);
    }
    bound(drives_, 1.0, 0.0);
  }

  /// H = J_qa,x M^-1 J_qa,x^T of the torques, counted by its mean.
  ProgrammeSolution solve_near(const JointVector& wanted, ProgrammeVector& z_r) {
    programme_.C.conservativeResize(rows_, drives_ + 1);
    programme_.d.conservativeResize(rows_);
    z_r.resize(drives_ + 1);
    z_r << wanted / settings_.max_torque, 0.0;
    if ((programme_.C * z_r - programme_.d).minCoeff() >= 0.0)
      return {.status = ProgrammeSolution::Status::solved, .z = z_r, .multipliers = {}, .steps = 0};
    const PlatformMatrix H = at_.J_qa_x * motion_.G;
    const double mean = H.trace() / drives_;
    programme_.H.setZero(drives_ + 1, drives_ + 1);
    programme_.H.topLeftCorner(drives_, drives_) = 0.5 / mean * (H + H.transpose());
    programme_.H.diagonal().array() += 1e-6;
    programme_.H(drives_, drives_) = 1.0;
    programme_.f = -programme_.H * z_r;
    programme_.f[drives_] = slack_price;
    return solve(programme_);
  }

  std::uint32_t binding(const ProgrammeSolution& solution) const {
    std::uint32_t mask = 0;
    for (int i = 0; i < solution.multipliers.size(); ++i) {
      if (solution.multipliers[i] > 0.0) mask |= names_[static_cast<std::size_t>(i)];
    }
    return mask;
  }

 private:
  /// What each drive's torque adds to the acceleration along `gradient`.
  JointVector by_torque(const PlatformVector& gradient) const {
    JointVector along(motion_.G.cols());
    for (Eigen::Index i = 0; i < along.size(); ++i) along[i] = gradient.dot(motion_.G.col(i));
    return along;
  }
  /// What barrier.gradient^T dv must be to come to the limit by braking with `a`.
  double acceleration_for(const Barrier& barrier, double h, double dh, double a) const {
    const double c = a / settings_.approach;
    const double root = std::sqrt(c * c + 2.0 * a * std::max(h, 0.0));
    const double alpha = h > 0.0 ? root - c : settings_.approach * h;
    const double slope = h > 0.0 ? a / root : settings_.approach;
    return -slope * dh - settings_.correction * (dh + alpha) - barrier.drift;
  }
  /// The largest acceleration in that direction that the drives can cause at this tick.
  double most_of(const JointVector& by_torque) const {
    return by_torque.cwiseProduct(range_.least).cwiseMax(by_torque.cwiseProduct(range_.most)).sum();
  }
  /// The largest acceleration that all drives together can cause in that direction.
  double reach_of(const JointVector& by_torque) const { return settings_.max_torque * by_torque.lpNorm<1>(); }

  void bound(int variable, double sign, double least) {
    programme_.C.row(rows_).setZero();
    programme_.C(rows_, variable) = sign;
    programme_.d[rows_] = least;
    names_[static_cast<std::size_t>(rows_++)] = 0;
  }

  const SafetyFilterSettings& settings_;
  const Kinematics& at_;
  const Motion& motion_;
  const TorqueRange& range_;
  int drives_;
  int rows_ = 0;
  double usual_reach_ = 0.0;  ///< along the first direction [m/s^2]
  std::array<std::uint32_t, max_constraints> names_{};
  QuadraticProgramme programme_;
};

/// The setting that a barrier stands for.
const char* key_of(BarrierKind kind) {
  switch (kind) {
    case BarrierKind::condition_number:
      return "max_condition_number";
    case BarrierKind::type_1_singularity:
      return "min_abs_det_B";
    case BarrierKind::type_2_singularity:
      return "min_abs_det_A";
    case BarrierKind::self_collision:
      return "min_self_collision_distance";
    case BarrierKind::distance:
      return "max_distance";
    case BarrierKind::rotation:
      return "max_rotation";
    case BarrierKind::drive_range:
      break;
  }
  return "min_active and max_active";
}

std::vector<std::string> problems(const SafetyFilterSettings& settings, const ParallelRobot& robot) {
  Findings found("limits: ");
  found.add_all(problems(settings.limits.workspace, robot));
  found.require(settings.max_platform_speed > 0, "max_platform_speed must be positive");
  found.require(settings.max_drive_speed > 0, "max_drive_speed must be positive");
  found.require(settings.max_torque > 0, "max_torque must be positive");
  found.require(settings.max_torque_rate > 0, "max_torque_rate must be positive");
  bool are_shares = true, have_hardest = true;
  for (int kind = 0; kind <= static_cast<int>(BarrierKind::drive_range); ++kind) {
    const double share = settings.braking.of(static_cast<BarrierKind>(kind));
    are_shares = are_shares && share > 0 && share <= 1;
    have_hardest = have_hardest && share <= settings.braking.hardest;
  }
  found.require(are_shares, "braking shares must be above 0 and at most 1");
  found.require(have_hardest, "no braking share may exceed the hardest");
  found.require(settings.braking.hardest <= 1, "the hardest braking share must be at most 1");
  found.require(settings.approach > 0 && settings.correction > 0 && settings.speed_rate > 0,
                "approach, correction and speed_rate must be positive");
  Kinematics home;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), home);
  BarrierList barriers;
  evaluate_barriers(robot, home, settings.limits, settings.margins, barriers);
  found.require(barriers.valid, "the home pose is no place that the robot can be kept at");
  for (int i = 0; i < barriers.count; ++i) {
    found.require(barriers[i].room > 0.0, std::string("the home pose must be within ") +
                                              key_of(barriers[i].kind) + ", and by its margin");
  }
  return found.take();
}

/// Limits are opened as far as the robot stood beyond them when keeping began, and close behind it.
void follow_excess(const BarrierList& barriers, bool begins, std::array<double, BarrierList::most>& excess) {
  for (int i = 0; i < barriers.count; ++i) {
    double& open = excess[static_cast<std::size_t>(i)];
    const double beyond = std::max(0.0, -barriers[i].room);
    open = begins ? beyond : std::min(open, beyond);
  }
}

}  // namespace

double BrakingShares::of(BarrierKind kind) const {
  switch (kind) {
    case BarrierKind::condition_number:
      return condition_number;
    case BarrierKind::type_1_singularity:
    case BarrierKind::type_2_singularity:
      return singularity;
    case BarrierKind::self_collision:
      return self_collision;
    case BarrierKind::distance:
      return distance;
    case BarrierKind::rotation:
      return rotation;
    case BarrierKind::drive_range:
      break;
  }
  return drive_range;
}

SafetyFilter::SafetyFilter(std::shared_ptr<const ParallelRobot> robot, const SafetyFilterSettings& settings)
    : robot_(std::move(robot)), settings_(settings) {
  throw_if_any(problems(settings, *robot_));
  settings_.correction =
      std::min(settings.correction, share_of_torque_rate * settings.max_torque_rate / settings.max_torque);
}

void SafetyFilter::keep_within(Time now, const Memory& last, const TorqueCommand& told,
                               const TorqueCommand& wanted, const PlatformMotion& moving,
                               const Kinematics& at, const Dynamics& model, const WrenchEstimate& pushed,
                               Result& result) const {
  result.memory = last;
  result.memory.keeping = false;
  result.torque = wanted;
  result.status = {.keeping = moving.status != PlatformMotion::Status::no_data};
  const bool is_usable =
      wanted.valid && wanted.torque.size() == robot_->drives() && wanted.torque.allFinite();
  if (!result.status.keeping || !is_usable) return;
  const Motion response = motion_of(at, model, pushed);
  BarrierList barriers;
  if (response.valid) evaluate_barriers(*robot_, at, settings_.limits, settings_.margins, barriers);
  if (!barriers.valid) return;
  result.memory.keeping = true;
  follow_excess(barriers, !last.keeping, result.memory.excess);

  const TorqueRange range = range_after(told, now, robot_->drives(), settings_);
  Programme programme(settings_, at, response, range);
  for (int i = 0; i < barriers.count; ++i)
    programme.add_barrier(barriers[i], result.memory.excess[static_cast<std::size_t>(i)]);
  programme.add_speeds();
  programme.add_bounds();

  ProgrammeVector z_r;
  const ProgrammeSolution solution = programme.solve_near(wanted.torque, z_r);
  result.status.steps = solution.steps;
  result.status.valid = solution.solved();
  if (solution.steps == 0) return;
  const JointVector found = settings_.max_torque * solution.z.head(robot_->drives());
  if (!found.allFinite()) return;
  result.torque.torque = found.cwiseMin(range.most).cwiseMax(range.least);
  result.status.binding = programme.binding(solution);
  result.status.slack = std::max(0.0, solution.z[robot_->drives()]);
  result.status.correction = (found - wanted.torque).lpNorm<Eigen::Infinity>();
}

}  // namespace flinch
