#include "systems/contact/link_particles.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

using Weights = std::array<double, max_particles>;
/// From the force of a particle, in the axes of its link, to the torques of the drives.
using TorqueMap = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_dof, 3>;

bool can_be_used(const LinkContactMap& link, const Kinematics& kinematics, const JointVector& torque) {
  return link.valid && kinematics.valid && usable(torque, drive_count(kinematics));
}

/// A fraction that has left the link comes back by as much.
double reflected(double fraction) {
  if (fraction >= 0.0 && fraction <= 1.0) return fraction;
  if (!std::isfinite(fraction)) return 0.5;
  const double folded = std::abs(std::remainder(fraction, 2.0));
  return std::min(folded, 1.0);
}

/// How likely drives feel `torque` where particles make `made`, without what is the same for all.
double likelihood(const JointVector& torque, const JointVector& made, const LinkParticleSettings& settings) {
  return std::exp(-0.5 * (torque - made).squaredNorm() / settings.torque_variance);  // [SafePR] (21)
}

}  // namespace

struct LinkParticles::TorqueMaps {
  TorqueMap at_joint, along;

  TorqueMaps(const LinkContactMap& link, const Kinematics& kinematics)
      : at_joint(kinematics.J_x_qa.transpose() * link.at_joint),
        along(kinematics.J_x_qa.transpose() * link.along) {}

  JointVector torque(const LinkParticle& particle) const {  // [SafePR] (22)
    return (at_joint + particle.fraction * along).lazyProduct(particle.force.head(at_joint.cols()));
  }

  /// The particle whose force leans by `lean` to the same side and that explains best what `particle` does:
  /// torques are linear in the force s across the link and in l s. Not on the link where there is none.
  LinkParticle leaning(const LinkParticle& particle, double lean) const {
    constexpr double least_share_apart = 1e-9;  // of one map that the other does not explain
    LinkParticle other = particle;
    other.fraction = -1.0;
    const double across = particle.force.tail<2>().norm();
    if (!(across > 0.0)) return other;
    Eigen::Vector3d direction = particle.force / across;
    direction[0] = lean;
    const JointVector a = at_joint * direction.head(at_joint.cols());
    const JointVector b = along * direction.head(along.cols());
    const JointVector felt = torque(particle);
    const double aa = a.squaredNorm(), ab = a.dot(b), bb = b.squaredNorm();
    const double determinant = aa * bb - ab * ab;
    if (!(determinant > least_share_apart * aa * bb)) return other;
    const double size = (bb * a.dot(felt) - ab * b.dot(felt)) / determinant;
    const double lever = (aa * b.dot(felt) - ab * a.dot(felt)) / determinant;
    if (!(size > 0.0)) return other;
    other.fraction = lever / size;
    other.force = size * direction;
    return other;
  }
};

LinkParticle LinkParticles::drawn_about(const LinkPush& push) noexcept {
  const Eigen::Matrix2d root = push.covariance.llt().matrixL();
  const Eigen::Vector2d spread = root * Eigen::Vector2d(random_.normal(), random_.normal());
  return {.fraction = reflected(push.fraction + spread[0]), .force = {0.0, push.force + spread[1], 0.0}};
}

void LinkParticles::begin(const LinkContactMap& link, const Kinematics& kinematics, const LinkPush& start,
                          const JointVector& drive_torque, const LinkParticleSettings& settings) noexcept {
  constexpr double least_fraction = 0.2;  // nearer to the elbow the force would be a large guess
  constexpr double jitter = 0.2;
  count_ = 0;
  if (!can_be_used(link, kinematics, drive_torque)) return;
  const TorqueMaps maps(link, kinematics);
  count_ = std::clamp(settings.particles, 1, max_particles);
  for (int i = 0; i < count_; ++i) {
    LinkParticle particle;
    if (start.identifiable) {
      particle = drawn_about(start);
    } else {
      particle.fraction = random_.uniform(0.0, 1.0);
      const double lever = std::max(particle.fraction, least_fraction);
      const auto across = (maps.at_joint + lever * maps.along).rightCols(maps.along.cols() - 1).eval();
      const auto fit = (across.transpose() * across).ldlt().solve(across.transpose() * drive_torque).eval();
      for (int axis = 0; axis < fit.size(); ++axis) {
        particle.force[axis + 1] =
            std::isfinite(fit[axis]) ? fit[axis] * (1.0 + jitter * random_.normal()) : 0.0;
      }
    }
    if (settings.lean())
      particle.force[0] = settings.leaning * random_.normal() * particle.force.tail<2>().norm();
    particles_[static_cast<std::size_t>(i)] = particle;
  }
}

void LinkParticles::take(const LinkParticles& other) noexcept {
  random_ = other.random_;
  count_ = other.count_;
  std::copy_n(other.particles_.begin(), count_, particles_.begin());
}

void LinkParticles::move(const LinkParticleSettings& settings, int directions) noexcept {
  const double along = settings.lean() ? std::sqrt(settings.along_variance) : 0.0;
  const double across = std::sqrt(settings.across_variance);
  const double fraction = std::sqrt(settings.fraction_variance);
  std::normal_distribution<double> normal;  // which makes its numbers in pairs
  for (int i = 0; i < count_; ++i) {        // [SafePR] (20)
    LinkParticle& particle = particles_[static_cast<std::size_t>(i)];
    particle.fraction = reflected(particle.fraction + fraction * normal(random_));
    if (settings.lean()) particle.force[0] += along * normal(random_);
    for (int axis = 1; axis < directions; ++axis) particle.force[axis] += across * normal(random_);
  }
}

void LinkParticles::resample(const Weights& weights, double sum) noexcept {
  const double step = sum / count_;
  double place = random_.uniform(0.0, step);
  double passed = weights[0];
  std::size_t drawn = 0;
  const auto count = static_cast<std::size_t>(count_);
  std::array<std::size_t, max_particles> from;  // never falls, so that none is taken that has been replaced
  for (std::size_t i = 0; i < count; ++i, place += step) {
    while (passed < place && drawn + 1 < count) passed += weights[++drawn];
    from[i] = drawn;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (from[i] > i) particles_[i] = particles_[from[i]];
  }
  for (std::size_t i = count; i-- > 0;) {
    if (from[i] < i) particles_[i] = particles_[from[i]];
  }
}

void LinkParticles::lean_anew(const TorqueMaps& maps, const JointVector& drive_torque, const Lean& lean,
                              const LinkParticleSettings& settings) noexcept {
  for (int i = 0; i < count_; ++i) {
    LinkParticle& particle = particles_[static_cast<std::size_t>(i)];
    const LinkParticle other = maps.leaning(particle, lean.mean + lean.deviation * random_.normal());
    if (!(other.fraction >= 0.0 && other.fraction <= 1.0)) continue;
    const double gained = likelihood(drive_torque, maps.torque(other), settings);
    const double had = likelihood(drive_torque, maps.torque(particle), settings);
    if (gained >= random_.uniform(0.0, 1.0) * had) particle = other;
  }
}

LinkParticleEstimate LinkParticles::step(const LinkContactMap& link, const Kinematics& kinematics,
                                         const JointVector& drive_torque,
                                         const LinkParticleSettings& settings) noexcept {
  if (count_ == 0 || !can_be_used(link, kinematics, drive_torque)) return {};
  const TorqueMaps maps(link, kinematics);
  move(settings, static_cast<int>(maps.along.cols()));
  Weights weights;
  double sum = 0.0;
  for (int i = 0; i < count_; ++i)
    sum += weights[static_cast<std::size_t>(i)] = likelihood(drive_torque, maps.torque((*this)[i]), settings);
  if (!(sum > 1e-300)) {
    std::fill_n(weights.begin(), count_, 1.0);
    sum = count_;
  }
  LinkParticleEstimate estimate{.valid = true, .fraction = 0.0};
  for (int i = 0; i < count_; ++i) {
    const double share = weights[static_cast<std::size_t>(i)] / sum;
    estimate.fraction += share * (*this)[i].fraction;
    estimate.force += share * (*this)[i].force;
  }
  const Eigen::Vector3d across(0.0, estimate.force[1], estimate.force[2]);
  const bool in_plane = maps.along.cols() == 2;  // where the force across has a sign, not a direction
  const Eigen::Vector3d direction =
      in_plane || across.isZero() ? Eigen::Vector3d(Eigen::Vector3d::UnitY()) : across.normalized();
  for (int i = 0; i < count_; ++i) {
    const double share = weights[static_cast<std::size_t>(i)] / sum;
    const Eigen::Vector2d off((*this)[i].fraction - estimate.fraction,
                              direction.dot((*this)[i].force - estimate.force));
    estimate.covariance += share * off * off.transpose();
  }
  resample(weights, sum);
  if (settings.lean()) {
    const Lean lean =
        lean_by_friction(link, kinematics.velocity, estimate.fraction, estimate.force.head(maps.along.cols()),
                         settings.leaning, settings.object_speed);
    lean_anew(maps, drive_torque, lean, settings);
  }
  return estimate;
}

}  // namespace flinch
