#include "systems/safety/encoder_monitor.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "tests/systems/safety/gated_inputs.h"

namespace flinch {
namespace {

using test::Inputs;
using test::Safety;

constexpr double limit = 0.25 * std::numbers::pi / 180.0;
constexpr FaultMask frozen = fault_bit(GateFault::encoder_frozen);
constexpr FaultMask jump = fault_bit(GateFault::encoder_jump);

/// Encoders without any noise.
class Encoders {
 public:
  JointAngles at(const Eigen::Vector3d& pose) const {
    return robot().inverse_kinematics(pose, robot().home_working_mode()).joints;
  }
  /// The faults found at the next tick, which `change` makes different from rest at home.
  template <class Change>
  FaultMask tick(Change change) {
    Inputs inputs(robot(), safety_.ticking.now());
    inputs.posture.joints.active = at(Eigen::Vector3d::Zero()).active;
    change(inputs);
    safety_.tick(inputs);
    return safety_.present();
  }
  FaultMask tick() {
    return tick([](Inputs&) {});
  }
  void rest(int ticks) {
    for (int k = 0; k < ticks; ++k) ASSERT_EQ(tick(), FaultMask{0});
  }
  const PlanarRrr& robot() const { return *safety_.robot; }

 private:
  Safety safety_;
};

TEST(EncoderMonitor, FindsNothingWrongWithARobotAtRestWhoseReadingsRepeat) { Encoders().rest(500); }

TEST(EncoderMonitor, WondersWhyADriveStandsStillWhoseCurrentHasChangedByMoreThanTheLimit) {
  for (const double start : {0.0, -3.0}) {
    for (const double change : {0.999, -0.999, 1.001, -1.001}) {
      Encoders encoders;
      for (int k = 0; k < 20; ++k) encoders.tick([start](Inputs& in) { in.drives.current[2] = start; });
      const auto drive = [&](Inputs& in) { in.drives.current[2] = start + change; };
      EXPECT_EQ(encoders.tick(drive), std::abs(change) > 1.0 ? frozen : 0);
    }
  }
}

TEST(EncoderMonitor, WondersNotBeforeTheAngleHasBeenRepeatedForMoreThanTheLimit) {
  Encoders encoders;
  encoders.rest(20);
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(encoders.tick([k](Inputs& in) {
      in.posture.joints.active[0] += 2e-7;  // the last that is new
      in.drives.current[0] = 10.0 * k;
    }),
              k > 5 ? frozen : 0);
  }
}

TEST(EncoderMonitor, SeesOneFrozenDriveByThePassiveAnglesThoughNoReferenceIsFollowed) {
  for (Eigen::Index drive = 0; drive < 3; ++drive) {
    Encoders encoders;
    encoders.rest(20);
    FaultMask found = 0;
    double missed = 0.0;
    for (int k = 1; found == 0 && missed < 1.0; ++k) {
      const Eigen::Vector3d pose = k * Eigen::Vector3d(2e-4, 1e-4, 3e-4);  // pushed by hand
      found = encoders.tick([&](Inputs& in) {
        const JointAngles home = encoders.at(Eigen::Vector3d::Zero());
        const JointAngles truth = encoders.at(pose);
        in.reference.valid = false;
        in.posture.joints = {in.posture.joints.acquired, true, true, truth.active, truth.passive};
        in.posture.joints.active[drive] = home.active[drive];
        in.posture.platform.pose =
            encoders.robot()
                .forward_kinematics(in.posture.joints.active, pose, encoders.robot().home_working_mode())
                .pose;
        missed = std::abs(truth.active[drive] - home.active[drive]);
      });
    }
    EXPECT_EQ(found, frozen);
    EXPECT_GT(missed, 0.2 * limit);
    EXPECT_LT(missed, 2.0 * limit);
  }
}

TEST(EncoderMonitor, TrustsAnEncoderThatChangesByOneIncrement) {
  Encoders encoders;
  encoders.rest(20);
  for (int k = 1; k < 100; ++k) {
    EXPECT_EQ(encoders.tick([k](Inputs& in) {
      in.drives.current.setConstant(k);
      in.posture.joints.active.array() += 2e-7 * ((k / 5 + 1) % 2);
    }),
              FaultMask{0});
  }
}

TEST(EncoderMonitor, ExpectsNoMotionAgainstClosedBrakes) {
  Encoders encoders;
  const auto tick = [&encoders](bool braked, double current) {
    return encoders.tick([&](Inputs& in) {
      in.station.braked = braked;
      in.drives.current.setConstant(current);
    });
  };
  for (int k = 0; k < 20; ++k) EXPECT_EQ(tick(false, 3.0), FaultMask{0});
  for (int k = 0; k < 20; ++k) EXPECT_EQ(tick(true, 0.0), FaultMask{0}) << "they close";
  for (int k = 0; k < 20; ++k) EXPECT_EQ(tick(false, 3.0), FaultMask{0}) << "and open under torque";
  EXPECT_EQ(tick(false, 1.9), frozen);
}

TEST(EncoderMonitor, HoldsNoAbsentReadingAgainstAnEncoder) {
  Encoders encoders;
  encoders.rest(20);
  for (int k = 1; k < 20; ++k) {
    const FaultMask found = encoders.tick([k](Inputs& in) {
      in.drives.current.setConstant(k);
      in.posture.joints.valid = false;
    });
    EXPECT_EQ(found & frozen, FaultMask{0});
  }
}

TEST(EncoderMonitor, JudgesWithoutPassiveAnglesByTheCurrentsAlone) {
  Encoders encoders;
  const auto tick = [&encoders](double current) {
    return encoders.tick([current](Inputs& in) {
      in.posture.joints.passive_valid = false;
      in.posture.joints.passive.setZero();
      in.drives.current[0] = current;
    });
  };
  for (int k = 0; k < 20; ++k) EXPECT_EQ(tick(0.0), FaultMask{0});
  EXPECT_EQ(tick(1.5), frozen);
}

TEST(EncoderMonitor, AllowsALargerStepAfterMissingReadings) {
  for (const double step : {0.0359, 0.0361}) {
    Encoders encoders;
    encoders.rest(20);
    for (int missing = 0; missing < 2; ++missing) {
      encoders.tick(
          [](Inputs& in) { in.posture.joints.active.setConstant(std::numeric_limits<double>::quiet_NaN()); });
    }
    EXPECT_EQ(encoders.tick([step](Inputs& in) { in.posture.joints.active[0] += step; }),
              step > 0.036 ? jump : 0);
  }
}

TEST(EncoderMonitor, SeesNoJumpWhereAnAngleWraps) {
  Encoders encoders;
  const auto turn = [&encoders](double angle) {
    return encoders.tick([angle](Inputs& in) { in.posture.joints.active[1] = angle; });
  };
  turn(std::numbers::pi - 0.001);
  EXPECT_EQ(turn(-std::numbers::pi + 0.001), FaultMask{0});
  EXPECT_EQ(turn(0.0), jump);
}

TEST(EncoderMonitor, FindsAJumpThatStays) {
  Encoders encoders;
  encoders.rest(20);
  const auto offset = [](Inputs& in) { in.posture.joints.active[1] += 0.1; };
  EXPECT_EQ(encoders.tick(offset), jump);
  EXPECT_EQ(encoders.tick(offset), FaultMask{0}) << "the gate latches, not the monitor";
}

}  // namespace
}  // namespace flinch
