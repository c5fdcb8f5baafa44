#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/diagrams/contact_rig.h"

namespace flinch {
namespace {

using enum ReactionMode;
using test::Bench;
using test::encoder_noise;
using test::RigExperiment;

/// The robot passes by anywhere, is struck, and ends up somewhere.
class Struck : public testing::TestWithParam<SafetyFilterSettings::Use> {
 protected:
  static RigExperiment experiment(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    RigExperiment experiment;
    experiment.friction = RigFriction::test_rig;
    experiment.station.encoder_noise = encoder_noise;
    const double direction = std::numbers::pi * unit(random);
    const PlanarRrr robot(rig_robot(RigGeometry::individual, experiment.friction));
    const Passage passing =
        passage(robot, {.pose = Eigen::Vector3d(0.12 * unit(random), 0.12 * unit(random), 0.2 * unit(random)),
                        .direction = Eigen::Vector2d(std::cos(direction), std::sin(direction)),
                        .speed = 0.8 + 0.6 * unit(random),
                        .cruise = 0.05});
    experiment.station.pose = passing.path.start();
    experiment.control.trajectory.path = passing.path;
    experiment.control.trajectory.start = 300ms;
    experiment.control.limits.use = GetParam();
    experiment.control.limits.limits.workspace = experiment.control.faults.workspace;
    return experiment;
  }

  /// A push of up to 250 N for 40 ms, which begins on the way.
  static void strike(Bench& rig, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    rig.run(350ms + Time(static_cast<std::int64_t>(1e8 * std::abs(unit(random)))));
    rig.push(Eigen::Vector3d(250.0 * unit(random), 250.0 * unit(random), 10.0 * unit(random)));
    rig.run(40ms);
    rig.push(PlatformVector());
    rig.run(800ms);
  }

  /// What the operator does, whatever has happened: reset; where the gate then is recovering, a target
  /// inside, which it reaches slowly; and home. Docs: faults.md, "How an operator brings the robot back".
  static void bring_home(Bench& rig) {
    const Eigen::Vector3d home = Eigen::Vector3d::Zero();
    rig.reset();
    rig.tick();
    if (rig.state().mode == recover) {
      rig.go_to(home);
      for (int k = 0; k < 12'000 && rig.state().mode == recover; ++k) rig.tick();
    }
    rig.run(10ms);
    rig.go_to(home);
    rig.run(8s);
  }
};
INSTANTIATE_TEST_SUITE_P(OperatorRecovery, Struck,
                         testing::Values(SafetyFilterSettings::Use::never,
                                         SafetyFilterSettings::Use::after_contact));

TEST_P(Struck, IsBroughtHomeByOneSequenceFromWhereverItEnds) {
  std::mt19937 random(11);
  int floated = 0, held = 0, closed = 0;
  for (int trial = 0; trial < 25; ++trial) {
    Bench rig(experiment(random));
    strike(rig, random);
    floated += rig.state().mode == zero_g ? 1 : 0;
    held += rig.state().mode == hold ? 1 : 0;
    closed += rig.gate().phase == GatePhase::closed ? 1 : 0;
    bring_home(rig);
    EXPECT_EQ(rig.gate().phase, GatePhase::open) << trial;
    EXPECT_EQ(rig.state().mode, nominal) << trial;
    EXPECT_LT(rig.pose().norm(), 2e-3) << trial;
  }
  std::printf("  %d in zero gravity, %d held, %d stopped by the gate\n", floated, held, closed);
  EXPECT_GT(floated, 5);
}

}  // namespace
}  // namespace flinch
