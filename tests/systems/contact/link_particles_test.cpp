#include "systems/contact/link_particles.h"

#include <cmath>
#include <limits>

#include "tests/support/allocations.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

struct Trial {
  std::shared_ptr<const PlanarRrr> robot = test::touched_bench();
  Kinematics k = test::at_home(*robot);
  LinkContactMap link = link_contact_map(*robot, k, BodyId::link2(0));

  JointVector torque(double fraction, const Eigen::Vector2d& force) const {
    return drive_torques(k, (link.at_joint + fraction * link.along) * CartesianVector(force));
  }
};

/// Mean size of the errors of 40 filters after the first and the 50th step.
struct Errors {
  double first_fraction = 0.0, last_fraction = 0.0, last_force = 0.0;
};

Errors run(const LinkParticleSettings& settings, const LinkPush& start, double fraction, double force) {
  const Trial trial;
  const JointVector torque = trial.torque(fraction, {0.0, force});
  constexpr int trials = 40;
  Errors errors;
  for (int i = 0; i < trials; ++i) {
    LinkParticles particles(static_cast<std::uint64_t>(i) + 1);
    particles.begin(trial.link, trial.k, start, torque, settings);
    LinkParticleEstimate found;
    for (int step = 0; step < 50; ++step) {
      found = particles.step(trial.link, trial.k, torque, settings);
      EXPECT_TRUE(found.valid);
      if (step == 0) errors.first_fraction += std::abs(found.fraction - fraction) / trials;
    }
    errors.last_fraction += std::abs(found.fraction - fraction) / trials;
    errors.last_force += std::abs(found.force[1] - force) / trials;
  }
  std::printf("  R = %d: fraction off by %.4f after a step, %.4f after 50; force by %.2f N\n",
              settings.particles, errors.first_fraction, errors.last_fraction, errors.last_force);
  return errors;
}

// Noise-free torques of 60 N at 0.7 of the link, from anywhere on it: as the paper's 4 % and 4 N after 50 ms.
TEST(LinkParticles, FindAPushFromAnywhereOnTheLink) {
  const Errors few = run({.particles = 50, .leaning = 0.0}, {}, 0.7, 60.0);
  EXPECT_LT(few.last_fraction, 0.04);
  EXPECT_LT(few.last_force, 4.0);
  const Errors many = run({.particles = 200, .leaning = 0.0}, {}, 0.7, 60.0);
  EXPECT_LT(many.last_fraction, few.last_fraction);
}

TEST(LinkParticles, StartedFromTheClosedFormAreThereAtOnce) {
  const LinkPush start{.valid = true,
                       .identifiable = true,
                       .fraction = 0.7,
                       .force = 60.0,
                       .covariance = Eigen::Vector2d(1e-4, 1.0).asDiagonal()};
  const Errors errors = run({.particles = 50, .leaning = 0.0}, start, 0.7, 60.0);
  EXPECT_LT(errors.first_fraction, 0.01);
  EXPECT_LT(errors.last_fraction, 0.02);
  EXPECT_LT(errors.last_force, 2.0);
}

TEST(LinkParticles, OfASeedAreTheSameBitForBit) {
  const Trial trial;
  const JointVector torque = trial.torque(0.4, {0.0, -30.0});
  LinkParticles a(7), b(7), other(8);
  for (LinkParticles* each : {&a, &b, &other}) each->begin(trial.link, trial.k, {}, torque, {});
  LinkParticleEstimate of_a, of_b, of_other;
  for (int i = 0; i < 20; ++i) {
    of_a = a.step(trial.link, trial.k, torque, {});
    of_b = b.step(trial.link, trial.k, torque, {});
    of_other = other.step(trial.link, trial.k, torque, {});
  }
  EXPECT_EQ(of_a.fraction, of_b.fraction);
  EXPECT_EQ(of_a.force, of_b.force);
  EXPECT_NE(of_a.fraction, of_other.fraction);
}

TEST(LinkParticles, StayOnTheLinkAndFiniteWhateverTheTorque) {
  const Trial trial;
  for (const double size : {0.0, 1e-3, 1e3, 1e8}) {
    LinkParticles particles(3);
    const JointVector torque = JointVector::Constant(3, size);
    particles.begin(trial.link, trial.k, {}, torque, {});
    for (int i = 0; i < 100; ++i) {
      const LinkParticleEstimate found = particles.step(trial.link, trial.k, torque, {});
      ASSERT_TRUE(found.valid);
      ASSERT_TRUE(found.force.allFinite() && found.covariance.allFinite());
      ASSERT_GE(found.fraction, 0.0);
      ASSERT_LE(found.fraction, 1.0);
    }
  }
}

TEST(LinkParticles, AreNotThereBeforeTheyBeginNorForUnusableInput) {
  const Trial trial;
  LinkParticles particles(1);
  const JointVector torque = trial.torque(0.5, {0.0, 20.0});
  EXPECT_FALSE(particles.step(trial.link, trial.k, torque, {}).valid);
  particles.begin(trial.link, trial.k, {}, JointVector::Constant(3, std::numeric_limits<double>::quiet_NaN()),
                  {});
  EXPECT_EQ(particles.count(), 0);
  particles.begin(trial.link, trial.k, {}, torque, {});
  EXPECT_EQ(particles.count(), 50);
  EXPECT_FALSE(particles.step(LinkContactMap(), trial.k, torque, {}).valid);
  EXPECT_FALSE(particles.step(trial.link, Kinematics(), torque, {}).valid);
  EXPECT_TRUE(particles.step(trial.link, trial.k, torque, {}).valid);
}

TEST(LinkParticles, NeverAllocate) {
  const Trial trial;
  const JointVector torque = trial.torque(0.5, {0.0, 20.0});
  LinkParticles particles(1);
  const test::AllocationCounter allocations;
  particles.begin(trial.link, trial.k, {}, torque, {.particles = max_particles});
  particles.step(trial.link, trial.k, torque, {.particles = max_particles});
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace flinch
