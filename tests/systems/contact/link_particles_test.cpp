#include "systems/contact/link_particles.h"
#include "systems/robot/decompositions.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "systems/framework/random.h"
#include "tests/support/allocations.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

struct Trial {
  std::shared_ptr<const PlanarRrr> robot = test::touched_rig();
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

/// From where particles start.
enum class Start { anywhere, closed_form, wrong };

/// Of many pushes across second links: how far filters end from the closed form of the mean torques that they
/// have seen.
struct Agreement {
  int pushes = 0;
  double squared = 0.0;  ///< mean of d^T (P + C)^-1 d: P of the particles, C of the closed form
  double covered = 0.0;  ///< share of which that is below 5.99, 95 % of chi-square with two degrees
  double median = 0.0;   ///< of how far the fraction is off
};

/// The push that the closed form finds in torques of independent drives.
LinkPush closed_form(const LinkContactMap& link, const Kinematics& k, const JointVector& torque,
                     double torque_variance) {
  const PlatformMatrix to_wrench = k.J_x_qa.transpose().inverse();
  return link_push(link, to_wrench * torque, torque_variance * to_wrench * to_wrench.transpose(), 0.15);
}

Agreement agreement(const LinkParticleSettings& settings, Start from, int steps, int pushes,
                    double torque_deviation) {
  const auto robot = test::touched_rig();
  RandomGenerator random(3);
  Agreement found;
  std::vector<double> off;
  for (const Kinematics& k : test::random_kinematics(*robot, pushes)) {
    const LinkContactMap link = link_contact_map(*robot, k, BodyId::link2(static_cast<int>(random() % 3)));
    const double side = random.uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
    const double fraction = random.uniform(0.1, 0.9), force = side * random.uniform(40.0, 80.0);
    const CartesianVector push = Eigen::Vector2d(0.0, force);
    const JointVector torque = drive_torques(k, (link.at_joint + fraction * link.along) * push);
    LinkPush start;
    if (from == Start::closed_form) start = closed_form(link, k, torque, settings.torque_variance);
    if (from == Start::wrong) {
      start = {.valid = true,
               .identifiable = true,
               .fraction = fraction + (fraction > 0.5 ? -0.4 : 0.4),
               .force = 0.5 * force,
               .covariance = Eigen::Vector2d(1e-4, 1.0).asDiagonal()};
    }
    LinkParticles particles(random());
    LinkParticleEstimate mean;
    JointVector seen = JointVector::Zero(3);
    for (int step = 0; step < steps; ++step) {
      JointVector felt = torque;
      for (double& each : felt) each += torque_deviation * random.normal();
      seen += felt / steps;
      if (step == 0) particles.begin(link, k, start, felt, settings);
      mean = particles.step(link, k, felt, settings);
    }
    const LinkPush exact = closed_form(link, k, seen, settings.torque_variance / steps);
    if (!exact.identifiable) continue;
    const Eigen::Vector2d d(mean.fraction - exact.fraction, mean.force[1] - exact.force);
    Eigen::Matrix2d of_both = mean.covariance;
    if (torque_deviation > 0.0) of_both += exact.covariance;
    const double squared = d.dot(of_both.llt().solve(d));
    ++found.pushes;
    found.squared += squared;
    found.covered += squared < 5.991;
    off.push_back(std::abs(d[0]));
  }
  found.squared /= found.pushes;
  found.covered /= found.pushes;
  std::sort(off.begin(), off.end());
  found.median = off[off.size() / 2];
  std::printf(
      "  R = %d, torques off by %.2f Nm, after %d: squared difference %.2f, covered %.1f %%, fraction off "
      "by %.4f\n",
      settings.particles, torque_deviation, steps, found.squared, 100.0 * found.covered, found.median);
  return found;
}

void expect_agreement(const Agreement& found) {
  EXPECT_LT(found.squared, 2.0 + 1.96 * 2.0 / std::sqrt(found.pushes));  // chi-square with two degrees
  EXPECT_GT(found.covered, 0.95 - 1.96 * std::sqrt(0.95 * 0.05 / found.pushes));
}

const double papers_noise =
    std::sqrt(LinkParticleSettings().torque_variance);  // Sigma_meas, anew at every step

TEST(LinkParticles, EndWhereTheClosedFormDoes) {
  for (const double noise : {0.0, papers_noise}) {
    const Agreement near = agreement({.particles = 50, .leaning = 0.0}, Start::closed_form, 50, 300, noise);
    const Agreement anywhere = agreement({.particles = 200, .leaning = 0.0}, Start::anywhere, 50, 300, noise);
    for (const Agreement& found : {near, anywhere}) {
      EXPECT_GT(found.pushes, 280);
      expect_agreement(found);
      EXPECT_LT(found.median, 0.01);
    }
  }
}

// They are sure of a place 0.4 of the link away, and may wander 0.0016 of it at a step.
TEST(LinkParticles, ComeFromAWrongStartToTheClosedForm) {
  const LinkParticleSettings settings{.particles = 200, .leaning = 0.0};
  for (const double noise : {0.0, papers_noise}) {
    const double early = agreement(settings, Start::wrong, 50, 100, noise).median;
    const double later = agreement(settings, Start::wrong, 600, 100, noise).median;
    const Agreement last = agreement(settings, Start::wrong, 2000, 100, noise);
    EXPECT_GT(early, 0.25);
    EXPECT_LT(later, 0.1 * early);
    expect_agreement(last);
    EXPECT_LT(last.median, 0.01);
  }
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
