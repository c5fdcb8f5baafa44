#include "systems/contact/particle_locator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

ParticleLocator::ParticleLocator(std::shared_ptr<const ParallelRobot> robot,
                                 const LinkParticleSettings& settings,
                                 const ContactLocatorSettings& closed_form,
                                 const WrenchUncertainty& uncertainty, std::uint64_t seed)
    : robot_(std::move(robot)),
      classes_(robot_->body_count(), robot_->legs()),
      platform_(robot_->body(BodyId::platform()).shapes),
      settings_(settings),
      closed_form_(closed_form),
      uncertainty_(uncertainty) {
  Findings found("particle filter: ");
  found.require(settings.particles > 0 && settings.particles <= max_particles,
                "particles must be between 1 and " + std::to_string(max_particles));
  found.positive("fraction_variance", settings.fraction_variance);
  found.not_negative("along_variance", settings.along_variance, "N^2");
  found.positive("across_variance", settings.across_variance, "N^2");
  found.positive("torque_variance", settings.torque_variance);
  found.not_negative("leaning", settings.leaning);
  found.positive("object_speed", settings.object_speed, "m/s");
  found.positive("least_force", closed_form.least_force, "N");
  found.positive("largest_deviation", closed_form.largest_deviation);
  uncertainty.find_problems(found);
  throw_if_any(found.take());
  memory_ = state<Memory>("memory", Memory{LinkParticles(seed), -1, {}});
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
  next.location = {};
  const int number = touched.most_likely;
  const bool collides =
      contact.active && touched.valid && classes_.contains(number) && !classes_.is_clamping(number);
  const bool on_link2 = collides && ContactClasses::body(number).is_link2();
  if (!on_link2) {
    next.particles.clear();
    next.body = -1;
  }
  const bool can_be_read = collides && at.valid && estimate.valid &&
                           usable(estimate.wrench_in_base, robot_->dof()) && lately.valid &&
                           usable(lately.wrench_in_base, robot_->dof());
  if (!can_be_read) return;
  const PlatformVector& F = estimate.wrench_in_base;
  const PlatformMatrix noise = uncertainty_.covariance(robot_->space(), at, F);
  const PlatformMatrix errors = uncertainty_.errors(robot_->space(), at, F, lately.wrench_in_base);
  if (ContactClasses::body(number).is_platform())
    next.location = locate_on_platform(*robot_, at, platform_, F, noise, errors, closed_form_.least_force);
  if (on_link2) {
    const LinkContactMap link = link_contact_map(*robot_, at, BodyId::from_index(number));
    if (next.body != number || contact.begins(now)) {
      const LinkPush push = link_push(link, F, noise, closed_form_.largest_deviation);
      next.particles.begin(link, at, push, estimate.drive_torque, settings_);
      next.body = number;
    }
    const LinkParticleEstimate mean = next.particles.step(link, at, estimate.drive_torque, settings_);
    if (mean.valid) next.location = locate_on_link2(link, mean, F, noise, errors);
    next.location.body = number;
  }
}

ContactLocation ParticleLocator::read(const Memory& next, const WrenchEstimate& estimate) const {
  ContactLocation found = next.location;
  found.acquired = estimate.acquired;
  return found;
}

ContactLocation ParticleLocator::locate_on_link2(const LinkContactMap& link, const LinkParticleEstimate& mean,
                                                 const PlatformVector& felt, const PlatformMatrix& noise,
                                                 const PlatformMatrix& errors) const {
  const CartesianVector force = mean.force.head(link.axes.cols());
  ContactLocation found;
  // Particles take the errors of the torques as new at every tick. Those of the wrench stay, and move all of
  // them alike.
  found.covariance = mean.covariance + push_covariance(link, mean.fraction, force, errors);
  found.valid = found.covariance.allFinite();
  found.fraction = mean.fraction;
  found.force_in_base = link.axes * force;
  found.point_in_base = pushed_point(link, mean.fraction, found.force_in_base);
  const double deviation = std::sqrt(found.covariance(0, 0));
  found.point_deviation = link.length * deviation;
  found.force_deviation = std::sqrt(found.covariance(1, 1));
  found.located = deviation <= closed_form_.largest_deviation;
  found.residual = unexplained(felt - (link.at_joint + mean.fraction * link.along) * force, noise);
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
