#include "systems/estimators/momentum_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double T = 1e-3;
const PlatformVector gains{{20.0, 135.0, 500.0}};
const PlatformVector zero = PlatformVector::Zero(3);

std::shared_ptr<const PlanarRrr> rig() {
  return std::make_shared<PlanarRrr>(rig_robot(RigGeometry::nominal, RigFriction::none));
}

/// What an observer sees of a rigid body of constant inertia, driven directly: F_a = torque.
struct Inputs {
  PlatformMotion platform;
  Kinematics kinematics;
  Dynamics dynamics;
  DriveTorque torque;

  static PlatformMatrix inertia() { return Eigen::Vector3d(4.0, 3.0, 0.05).asDiagonal(); }

  Inputs(Time now, const PlatformVector& momentum, const PlatformVector& F_a,
         const PlatformVector& beta = zero) {
    const PlatformVector velocity = momentum.cwiseQuotient(PlatformVector(inertia().diagonal()));
    platform = {now, PlatformMotion::Status::valid, zero, velocity};
    kinematics.velocity = velocity;
    kinematics.joints.active = zero;
    kinematics.J_qa_x.setIdentity(3, 3);
    kinematics.J_x_qa.setIdentity(3, 3);
    kinematics.valid = kinematics.reachable = true;
    dynamics = {inertia(), PlatformMatrix::Zero(3, 3), beta, zero, true};
    torque = {now, true, F_a};
  }
};

struct Observer {
  explicit Observer(TorqueTiming timing = TorqueTiming::sampled, const PlatformVector& gain = gains)
      : block(builder.add<MomentumObserver>("observer", rig(), MomentumObserverSettings{gain, timing, {}})),
        platform(builder.export_input("platform", block.platform)),
        kinematics(builder.export_input("kinematics", block.kinematics)),
        dynamics(builder.export_input("dynamics", block.dynamics)),
        torque(builder.export_input("torque", block.torque)),
        ticking(builder) {}

  const WrenchEstimate& see(const Inputs& inputs) {
    ticking.set(platform, inputs.platform);
    ticking.set(kinematics, inputs.kinematics);
    ticking.set(dynamics, inputs.dynamics);
    ticking.set(torque, inputs.torque);
    ticking.tick();
    return ticking.get(block.wrench);
  }
  /// The body, so far pushed from rest by a constant wrench alone.
  const WrenchEstimate& see_pushed(const PlatformVector& F_ext) {
    const Time now = ticking.now();
    return see(Inputs(now, to_seconds(now) * F_ext, zero));
  }
  const WrenchEstimate& miss() {
    Inputs inputs(ticking.now(), zero, zero);
    inputs.platform.status = PlatformMotion::Status::no_data;
    return see(inputs);
  }

  DiagramBuilder builder;
  MomentumObserver& block;
  InputPort<PlatformMotion> platform;
  InputPort<Kinematics> kinematics;
  InputPort<Dynamics> dynamics;
  InputPort<DriveTorque> torque;
  test::Ticking ticking;
};

PlatformVector step_response(const PlatformVector& F_ext, double t) {
  return F_ext.array() * (1.0 - (-t * gains.array()).exp());
}

PlatformVector random_vector(RandomGenerator& random, double size) {
  return PlatformVector::NullaryExpr(3, [&] { return random.uniform(-size, size); });
}

class MomentumObserverOfEitherTiming : public testing::TestWithParam<TorqueTiming> {
 protected:
  Observer observer_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(MomentumObserver, MomentumObserverOfEitherTiming,
                         testing::Values(TorqueTiming::sampled, TorqueTiming::held));

TEST_P(MomentumObserverOfEitherTiming, RespondsToAStepWithItsTimeConstants) {
  const PlatformVector F_ext{{80.0, -15.0, 2.0}};
  for (int k = 0; k < 1000; ++k) {
    const PlatformVector estimate = observer_.see_pushed(F_ext).wrench_in_base;
    ASSERT_LT((estimate - step_response(F_ext, k * T)).norm(), 1e-10) << k;
  }
}

TEST_P(MomentumObserverOfEitherTiming, TellsTheDeviationThatNoiseOfTheMomentumCauses) {
  RandomGenerator random(17);
  const MomentumDeviation deviation;
  PlatformVector squares = PlatformVector::Zero(3), told;
  constexpr int settled = 500, counted = 20'000;
  for (int k = 0; k < settled + counted; ++k) {
    PlatformVector momentum{{deviation.translation, deviation.translation, deviation.rotation}};
    for (double& each : momentum) each *= random.normal();
    const WrenchEstimate& seen = observer_.see(Inputs(observer_.ticking.now(), momentum, zero));
    if (k >= settled) squares += seen.wrench_in_base.cwiseAbs2() / counted;
    told = seen.standard_deviation;
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(told[i] / std::sqrt(squares[i]), 1.0, 0.05) << i;
}

// dF/dt = K_o (F_ext - F): the response to alpha t is alpha (t - (1 - exp(-k_o t)) / k_o). A ramp is constant
// over an interval only on average, hence an error of at most half an interval of it.
TEST_P(MomentumObserverOfEitherTiming, FollowsARampWithTheLagOfItsTimeConstants) {
  const PlatformVector alpha{{2000.0, -500.0, 30.0}};
  for (int k = 0; k < 500; ++k) {
    const double t = k * T;
    const Inputs inputs(observer_.ticking.now(), 0.5 * t * t * alpha, zero);
    const PlatformVector expected = alpha.array() * (t - (1.0 - (-t * gains.array()).exp()) / gains.array());
    const Eigen::Array3d error = observer_.see(inputs).wrench_in_base - expected;
    ASSERT_TRUE((error.abs() <= 0.5 * T * alpha.array().abs()).all()) << k;
  }
}

// Whatever momentum, torque and beta do: where they are consistent there is no external wrench.
TEST_P(MomentumObserverOfEitherTiming, SeesNothingInAMotionThatItsInputsExplain) {
  RandomGenerator random(1);
  PlatformVector momentum = random_vector(random, 10.0);
  PlatformVector last_torque = random_vector(random, 50.0);
  PlatformVector last_beta = random_vector(random, 50.0);
  observer_.see(Inputs(observer_.ticking.now(), momentum, last_torque, last_beta));
  for (int k = 0; k < 1000; ++k) {
    const PlatformVector torque = random_vector(random, 50.0);
    const PlatformVector beta = random_vector(random, 50.0);
    const PlatformVector acting =
        GetParam() == TorqueTiming::held ? torque : PlatformVector(0.5 * (torque + last_torque));
    momentum += T * (acting - 0.5 * (beta + last_beta));
    const WrenchEstimate& estimate = observer_.see(Inputs(observer_.ticking.now(), momentum, torque, beta));
    ASSERT_LT(estimate.wrench_in_base.norm(), 1e-10) << k;
    last_torque = torque;
    last_beta = beta;
  }
}

TEST_P(MomentumObserverOfEitherTiming, DependsOnChangesOfTheMomentumOnly) {
  RandomGenerator random(2);
  Observer other(GetParam());
  const PlatformVector initial = random_vector(random, 10.0);
  for (int k = 0; k < 300; ++k) {
    const PlatformVector momentum = random_vector(random, 0.1);
    const PlatformVector torque = random_vector(random, 50.0);
    const Time now = observer_.ticking.now();
    const PlatformVector estimate = observer_.see(Inputs(now, momentum, torque)).wrench_in_base;
    const PlatformVector shifted = other.see(Inputs(now, momentum + initial, torque)).wrench_in_base;
    ASSERT_LT((estimate - shifted).norm(), 1e-9);
  }
}

TEST_P(MomentumObserverOfEitherTiming, StaysExactAcrossOneAndTwoMissingSamples) {
  const PlatformVector F_ext{{80.0, -15.0, 2.0}};
  RandomGenerator random(3);
  int missing = 0;
  for (int k = 0; k < 1000; ++k) {
    if (k > 0 && missing < 2 && random.uniform(0.0, 1.0) < 0.4) {
      observer_.miss();
      ++missing;
      continue;
    }
    missing = 0;
    const PlatformVector estimate = observer_.see_pushed(F_ext).wrench_in_base;
    ASSERT_LT((estimate - step_response(F_ext, k * T)).norm(), 1e-10) << k;
  }
}

TEST(MomentumObserver, IsValidFromFiveOfItsLongestTimeConstantsOn) {
  Observer observer;
  for (int k = 0; k < 400; ++k) {
    ASSERT_EQ(observer.see_pushed(PlatformVector::Ones(3)).valid, k >= 250) << k;
  }
}

TEST(MomentumObserver, IsNotValidBeforeItsInputsHaveSettled) {
  Observer observer(TorqueTiming::sampled, PlatformVector::Constant(3, 500.0));
  for (int k = 0; k < 40; ++k) {
    ASSERT_EQ(observer.see_pushed(PlatformVector::Ones(3)).valid, k >= 27) << k;
  }
}

TEST(MomentumObserver, HoldsItsEstimateForTwoMissingSamplesAndNotForThree) {
  Observer observer;
  for (int k = 0; k < 300; ++k) observer.see_pushed(PlatformVector::Ones(3));
  const PlatformVector last = observer.ticking.get(observer.block.wrench).wrench_in_base;
  for (int missing = 1; missing <= 2; ++missing) {
    const WrenchEstimate& held = observer.miss();
    EXPECT_TRUE(held.valid);
    EXPECT_EQ(held.acquired, 299ms);
    EXPECT_EQ(held.wrench_in_base, last);
  }
  const WrenchEstimate& expired = observer.miss();
  EXPECT_FALSE(expired.valid);
  EXPECT_EQ(expired.wrench_in_base, zero);
}

TEST(MomentumObserver, StartsAnewAfterAnInterruption) {
  const PlatformVector F_ext = PlatformVector::Constant(3, 50.0);
  Observer observer;
  for (int k = 0; k < 300; ++k) observer.see_pushed(F_ext);
  for (int k = 0; k < 3; ++k) observer.miss();
  for (int k = 0; k < 400; ++k) {
    const WrenchEstimate& estimate = observer.see_pushed(F_ext);
    ASSERT_EQ(estimate.valid, k >= 250);
    ASSERT_LT((estimate.wrench_in_base - step_response(F_ext, k * T)).norm(), 1e-9);
  }
}

TEST(MomentumObserver, StartsAnewWhereTheTimeOfAcquisitionJumps) {
  Observer observer;
  for (int k = 0; k < 300; ++k) observer.see_pushed(PlatformVector::Ones(3));
  const WrenchEstimate& estimate =
      observer.see(Inputs(observer.ticking.now() + 1s, 100.0 * PlatformVector::Ones(3), zero));
  EXPECT_FALSE(estimate.valid);
  EXPECT_EQ(estimate.wrench_in_base, zero);
}

TEST(MomentumObserver, DoesNotTakeTheSameSampleTwice) {
  Observer observer;
  for (int k = 0; k < 300; ++k) observer.see_pushed(PlatformVector::Ones(3));
  const PlatformVector last = observer.ticking.get(observer.block.wrench).wrench_in_base;
  EXPECT_EQ(observer.see(Inputs(299ms, zero, PlatformVector::Constant(3, 1000.0))).wrench_in_base, last);
}

TEST(MomentumObserver, NeverCallsWhatIsNotFiniteValid) {
  const auto break_input = [](Inputs& inputs, int which) {
    switch (which) {
      case 0:
        inputs.kinematics.velocity[0] = nan;
        return;
      case 1:
        inputs.dynamics.M_x(1, 1) = nan;
        return;
      case 2:
        inputs.dynamics.C_x(1, 2) = nan;
        return;
      case 3:
        inputs.dynamics.g_x[2] = nan;
        return;
      case 4:
        inputs.torque.torque[0] = nan;
        return;
      case 5:
        inputs.kinematics.J_qa_x(0, 0) = nan;
        return;
      case 6:
        inputs.kinematics.J_x_qa(0, 0) = nan;
        return;
      case 7:
        inputs.kinematics.velocity[0] = 1e308;
        return;  // p is infinite
      default:
        inputs.kinematics.velocity[0] = 1e306;
        return;  // dp / T is
    }
  };
  for (int which = 0; which < 9; ++which) {
    Observer observer;
    for (int k = 0; k < 300; ++k) observer.see_pushed(PlatformVector::Ones(3));
    for (int k = 0; k < 5; ++k) {
      Inputs inputs(observer.ticking.now(), zero, zero);
      break_input(inputs, which);
      const WrenchEstimate& estimate = observer.see(inputs);
      ASSERT_TRUE(estimate.wrench_in_base.allFinite() && estimate.drive_torque.allFinite()) << which;
    }
    EXPECT_FALSE(observer.ticking.get(observer.block.wrench).valid) << which;
    for (int k = 0; k < 300; ++k) observer.see_pushed(PlatformVector::Ones(3));
    EXPECT_TRUE(observer.ticking.get(observer.block.wrench).valid) << which;  // and it recovers
  }
}

TEST(MomentumObserver, ShowsTheWrenchAsTheDrivesFeelIt) {
  Observer observer;
  const PlatformVector F_ext{{80.0, -15.0, 2.0}};
  PlatformMatrix J_x_qa(3, 3);
  J_x_qa << -0.17, 0.33, -0.15, -0.28, -0.01, 0.29, -1.79, -1.79, -1.79;
  for (int k = 0; k < 300; ++k) {
    Inputs inputs(observer.ticking.now(), k * T * F_ext, zero);
    inputs.kinematics.J_x_qa = J_x_qa;
    const WrenchEstimate& estimate = observer.see(inputs);
    ASSERT_LT((estimate.drive_torque - J_x_qa.transpose() * estimate.wrench_in_base).norm(), 1e-12);
  }
}

TEST(MomentumObserver, DoesNotAllocate) {
  Observer observer;
  const Inputs good(0ms, zero, zero);
  const test::AllocationCounter allocations;
  for (int k = 0; k < 20; ++k) observer.see_pushed(zero);
  for (int k = 0; k < 5; ++k) observer.miss();
  observer.see(good);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(MomentumObserver, TakesTwentyPerSecondWhereNoGainIsGiven) {
  const MomentumObserver given(rig(), {PlatformVector::Constant(3, 20.0), TorqueTiming::sampled, {}});
  const MomentumObserver left_out(rig(), {});
  EXPECT_EQ(left_out.gain(), given.gain());
}

TEST(MomentumObserver, AsksForOnePositiveGainACoordinate) {
  for (const PlatformVector& gain : {PlatformVector(PlatformVector::Constant(2, 20.0)),
                                     PlatformVector{{20.0, 0.0, 20.0}}, PlatformVector{{20.0, nan, 20.0}}}) {
    EXPECT_THROW(MomentumObserver(rig(), MomentumObserverSettings{gain, TorqueTiming::sampled, {}}),
                 SetupError);
  }
}

}  // namespace
}  // namespace flinch
