#include "systems/contact/particle_locator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "systems/contact/contact_locator.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr double largest_deviation = ContactLocatorSettings().largest_deviation;

}  // namespace

ParticleLocator::ParticleLocator(std::shared_ptr<const ParallelRobot> robot,
                                 const LinkParticleSettings& settings, const WrenchUncertainty& uncertainty,
                                 std::uint64_t seed)
    : robot_(std::move(robot)),
      classes_(robot_->body_count(), robot_->legs()),
      settings_(settings),
      uncertainty_(uncertainty) {
  Findings found("particle filter: ");
  found.require(settings.particles > 0 && settings.particles <= max_particles,
                "particles must be between 1 and " + std::to_string(max_particles));
  found.positive("fraction_variance", settings.fraction_variance);
  found.not_negative("along_variance", settings.along_variance, "N^2");
  found.positive("across_variance", settings.across_variance, "N^2");
  found.positive("torque_variance", settings.torque_variance);
  found.not_negative("leaning", settings.leaning);
  uncertainty.find_problems(found);
  throw_if_any(found.take());
  memory_ = state<Memory>("memory", Memory{LinkParticles(seed), -1, {}, {}});
  next_ = intermediate<&ParticleLocator::advance>("next", clock, phase, classification, kinematics, wrench,
                                                  change, memory_);
  location = output<&ParticleLocator::read>("location", next_, wrench);
  cloud = output<&ParticleLocator::show>("cloud", next_);
  keep(memory_, next_);
}

void ParticleLocator::advance(Time now, const ContactPhase& contact, const ContactClassification& touched,
                              const Kinematics& at, const WrenchEstimate& estimate,
                              const WrenchEstimate& lately, const Memory& memory, Memory& next) const {
  next.particles.take(memory.particles);
  next.body = memory.body;
  next.estimate = {};
  next.link = {};
  const int number = touched.most_likely;
  const bool on_link2 = contact.active && touched.valid && classes_.contains(number) &&
                        !classes_.is_clamping(number) && ContactClasses::body(number).is_link2();
  if (!on_link2) {
    next.particles.clear();
    next.body = -1;
    return;
  }
  if (!estimate.valid || !at.valid || !usable(estimate.wrench_in_base, robot_->dof())) return;
  if (!lately.valid || !usable(lately.wrench_in_base, robot_->dof())) return;
  next.link = link_contact_map(*robot_, at, BodyId::from_index(number));
  if (next.body != number || contact.begins(now)) {
    const LinkPush push =
        link_push(next.link, estimate.wrench_in_base,
                  uncertainty_.covariance(robot_->space(), estimate.wrench_in_base), largest_deviation);
    next.particles.begin(next.link, at, push, estimate.drive_torque, settings_);
    next.body = number;
  }
  next.estimate = next.particles.step(next.link, at, estimate.drive_torque, settings_);
  if (!next.estimate.valid) return;
  // Particles take the errors of the torques as new at every tick. Those of the wrench stay, and move all of
  // them alike.
  next.estimate.covariance +=
      push_covariance(next.link, next.estimate.fraction, next.estimate.force.head(next.link.axes.cols()),
                      uncertainty_.errors(robot_->space(), estimate.wrench_in_base, lately.wrench_in_base));
}

ContactLocation ParticleLocator::read(const Memory& next, const WrenchEstimate& estimate) const {
  ContactLocation found;
  found.acquired = estimate.acquired;
  if (!next.estimate.valid || !next.link.valid) return found;
  const LinkParticleEstimate& mean = next.estimate;
  found.valid = mean.covariance.allFinite();
  found.body = next.body;
  found.fraction = mean.fraction;
  found.force_in_base = next.link.axes * mean.force.head(next.link.axes.cols());
  found.point_in_base = pushed_point(next.link, mean.fraction, found.force_in_base);
  found.covariance = mean.covariance;
  found.point_deviation = next.link.length * std::sqrt(mean.covariance(0, 0));
  found.force_deviation = std::sqrt(mean.covariance(1, 1));
  found.located = std::sqrt(mean.covariance(0, 0)) <= largest_deviation;
  return found;
}

void ParticleLocator::show(const Memory& next, ParticleCloud& shown) const {
  const bool shows_none_already = shown.body == next.body && shown.count == 0;
  if (next.particles.count() == 0 && shows_none_already) return;
  shown = ParticleCloud();
  shown.body = next.body;
  shown.count = std::min(next.particles.count(), ParticleCloud::most);
  for (int i = 0; i < shown.count; ++i) {
    shown.fraction[i] = next.particles[i].fraction;
    shown.force[i] = next.particles[i].force[1];
  }
}

}  // namespace flinch
