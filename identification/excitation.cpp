#include "identification/excitation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/motion/platform_path.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/dynamic_parameters.h"
#include "systems/robot/parameter_variants.h"

namespace flinch {
namespace {

constexpr double sample_period = 0.04;  // [s]
constexpr double torque_share = 0.8;    // of the largest torque
constexpr double seen = 1e-4;           // of the largest singular value
constexpr int most_draws = 1000;        // for one pose

/// What the way between two poses tells.
struct Way {
  Eigen::MatrixXd gram;  ///< Y^T Y of its samples
  double duration = 0.0;
  double peak_torque = 0.0;
};

class Designer {
 public:
  Designer(const ParallelRobot& robot, const ExcitationSettings& settings, std::uint64_t seed)
      : robot_(robot),
        settings_(settings),
        random_(derive_seed(seed, "excitation")),
        parameters_(DynamicParameters::of(robot)),
        variants_(*parameters_) {
    for (const DynamicParameter& parameter : parameters_->list()) scale_.push_back(parameter.deviation);
  }

  Excitation design(const std::function<void(double share)>& progress) {
    begin();
    Excitation result;
    rank_ = rank();
    result.first_condition = condition();
    double best = result.first_condition;
    for (int trial = 0; trial < settings_.trials; ++trial) {
      if (progress && trial % 20 == 0) progress(static_cast<double>(trial) / settings_.trials);
      const std::size_t which = 1 + random_() % (poses_.size() - 1);
      best = try_another(which, best);
    }
    result.poses = poses_;
    result.condition = best;
    result.rank = rank_;
    result.parameters = static_cast<int>(scale_.size());
    for (const Way& way : ways_) {
      result.duration += way.duration;
      result.peak_torque = std::max(result.peak_torque, way.peak_torque);
    }
    return result;
  }

 private:
  /// Random poses, as many as the duration holds.
  void begin() {
    const RandomPathSettings& path = settings_.path;
    poses_ = {path.centre.size() == 0 ? robot_.home_pose() : path.centre};
    double duration = 0.0;
    for (int draws = 0; duration < path.duration; ++draws) {
      if (draws == most_draws)
        throw SetupError("no random pose can be reached within the robot's limits; lower distance or speed");
      const Configuration next = random_pose(robot_, path, random_);
      std::optional<Way> way = way_between(poses_.back(), next);
      if (!way) continue;
      duration += way->duration;
      poses_.push_back(next);
      ways_.push_back(std::move(*way));
      draws = -1;
    }
  }

  /// The condition after another pose in this place, where it is lower; then the pose stays.
  double try_another(std::size_t which, double best) {
    const Configuration next = random_pose(robot_, settings_.path, random_);
    const std::optional<Way> there = way_between(poses_[which - 1], next);
    if (!there) return best;
    const bool is_last = which + 1 == poses_.size();
    const std::optional<Way> on = is_last ? std::optional<Way>() : way_between(next, poses_[which + 1]);
    if (!is_last && !on) return best;
    const std::vector<Way> before = ways_;
    ways_[which - 1] = *there;
    if (on) ways_[which] = *on;
    const double now = condition();
    if (now < best && duration() < 1.1 * settings_.path.duration) {
      poses_[which] = next;
      return now;
    }
    ways_ = before;
    return best;
  }

  std::optional<Way> way_between(const Configuration& a, const Configuration& b) const {
    try {
      const PlatformPath path = PlatformPath::through(robot_, {a, b}, settings_.path.limits);
      if (!stays_within(robot_, path, settings_.path)) return std::nullopt;
      return look_at(path);
    } catch (const SetupError&) {  // out of reach
      return std::nullopt;
    }
  }

  std::optional<Way> look_at(const PlatformPath& path) const {
    Way way;
    way.duration = path.duration();
    const auto p = static_cast<Eigen::Index>(scale_.size());
    way.gram.setZero(p, p);
    const Eigen::Map<const Eigen::VectorXd> scale(scale_.data(), p);
    for (double time = 0.5 * sample_period; time < path.duration(); time += sample_period) {
      const PlatformReference at = path.evaluate(time);
      Kinematics kinematics;
      robot_.kinematics(at.pose, at.velocity, kinematics);
      const JointVector torque = model_effort(robot_, kinematics, at.acceleration);
      way.peak_torque = std::max(way.peak_torque, torque.cwiseAbs().maxCoeff());
      if (way.peak_torque > torque_share * settings_.max_torque) return std::nullopt;
      const Eigen::MatrixXd Y = variants_.regressor(torque, kinematics, at.acceleration) * scale.asDiagonal();
      way.gram += Y.transpose() * Y;
    }
    return way;
  }

  double duration() const {
    double sum = 0.0;
    for (const Way& way : ways_) sum += way.duration;
    return sum;
  }

  /// Squared singular values of the regressor over all ways, the largest last.
  Eigen::VectorXd squared_values() const {
    Eigen::MatrixXd gram = ways_.front().gram;
    for (std::size_t i = 1; i < ways_.size(); ++i) gram += ways_[i].gram;
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram, Eigen::EigenvaluesOnly)
        .eigenvalues()
        .cwiseMax(0.0);
  }
  int rank() const {
    const Eigen::VectorXd values = squared_values();
    return static_cast<int>((values.array() > seen * seen * values[values.size() - 1]).count());
  }
  double condition() const {
    const Eigen::VectorXd values = squared_values();
    return std::sqrt(values[values.size() - 1] / std::max(values[values.size() - rank_], 1e-300));
  }

  const ParallelRobot& robot_;
  const ExcitationSettings& settings_;
  RandomGenerator random_;
  std::unique_ptr<const DynamicParameters> parameters_;
  ParameterVariants variants_;
  std::vector<double> scale_;
  std::vector<Configuration> poses_;
  std::vector<Way> ways_;
  int rank_ = 0;
};

}  // namespace

Excitation design_excitation(const ParallelRobot& robot, const ExcitationSettings& settings,
                             std::uint64_t seed, const std::function<void(double share)>& progress) {
  return Designer(robot, settings, seed).design(progress);
}

}  // namespace flinch
