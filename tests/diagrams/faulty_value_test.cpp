#include "diagrams/faulty_value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

/// A value with the fault that `text` asks for, fed by the test; the first tick is at 0 ms.
template <class Value>
class Faulty {
 public:
  explicit Faulty(const std::string& text) : ticking_(wire(text)) {}

  /// What is told at the next tick of what is true.
  Value told(const Value& truth) {
    ticking_.set(healthy_, truth);
    ticking_.tick();
    return ticking_.get(spoilt_);
  }

 private:
  DiagramBuilder& wire(const std::string& text) {
    const PlanarRrr robot(rig_robot(RigGeometry::nominal, RigFriction::none));
    const RequestedFaults faults{{parse_fault(text, robot)}, 1ms, 7};
    auto& before = builder_.add<FaultyValue<Value>>("healthy", RequestedFault{.begin = 1h}, 1ms, 0U);
    healthy_ = builder_.export_input("truth", before.healthy);
    spoilt_ = faults.add(builder_, "value", before.spoilt);
    return builder_;
  }

  DiagramBuilder builder_{"test", 1ms};
  InputPort<Value> healthy_;
  OutputPort<Value> spoilt_;
  test::Ticking ticking_;
};

JointReading joints(int tick) {
  JointReading reading;
  reading.acquired = Time(1ms) * tick;
  reading.valid = reading.passive_valid = true;
  reading.active = Eigen::Vector3d(0.1, 0.2, 0.3) * tick;
  reading.passive = Eigen::Vector3d(1.0, 2.0, 3.0) + Eigen::Vector3d::Constant(tick);
  return reading;
}

/// What a fault makes of readings at 0 to 9 ms.
std::vector<JointReading> told(const std::string& fault) {
  Faulty<JointReading> faulty(fault);
  std::vector<JointReading> all;
  for (int tick = 0; tick < 10; ++tick) all.push_back(faulty.told(joints(tick)));
  return all;
}

/// That nothing but one entry of the active angles is touched, and that from the fifth tick on, as `expected`
/// says of its tick.
template <class Expected>
void expect_second(const std::string& fault, Expected&& expected) {
  const std::vector<JointReading> all = told(fault);
  for (int tick = 0; tick < 10; ++tick) {
    const JointReading& reading = all[static_cast<std::size_t>(tick)];
    JointReading right = joints(tick);
    if (tick >= 5) right.active[1] = expected(tick);
    EXPECT_TRUE(reading.active.isApprox(right.active, 1e-12)) << fault << " at " << tick;
    EXPECT_EQ(reading.passive, right.passive) << fault << " at " << tick;
    EXPECT_EQ(reading.acquired, right.acquired) << fault << " at " << tick;
    EXPECT_TRUE(reading.valid && reading.passive_valid) << fault << " at " << tick;
  }
}

TEST(FaultyValue, ChangesOneNumberFromItsBeginOn) {
  expect_second("encoder2:stuck@0.005", [](int) { return 1.0; });
  expect_second("encoder2:wrong@0.005:0.7", [](int tick) { return 0.2 * tick + 0.7; });
  expect_second("encoder2:drifting@0.005:100", [](int tick) { return 0.2 * tick + 0.1 * (tick - 5); });
  expect_second("encoder2:scaled@0.005:2", [](int tick) { return 1.0 + 0.4 * (tick - 5); });
  expect_second("encoder2:reversed@0.005", [](int tick) { return 1.0 - 0.2 * (tick - 5); });
  expect_second("encoder2:delayed@0.005:0.003", [](int tick) { return 0.2 * (tick - 3); });
}

TEST(FaultyValue, OfAllTouchesEachOfThem) {
  const std::vector<JointReading> all = told("passive_encoders:wrong@0.005:0.5");
  EXPECT_TRUE(all[7].passive.isApprox((joints(7).passive.array() + 0.5).matrix()));
  EXPECT_EQ(all[7].active, joints(7).active);
}

TEST(FaultyValue, ThatIsOffIsNotValid) {
  EXPECT_FALSE(told("encoder1:off@0.005")[5].valid);
  EXPECT_TRUE(told("encoder1:off@0.005")[5].passive_valid);
  EXPECT_TRUE(told("encoder1:off@0.005")[4].valid);
  EXPECT_FALSE(told("passive_encoders:off@0.005")[5].passive_valid);
  EXPECT_TRUE(told("passive_encoders:off@0.005")[5].valid);
}

TEST(FaultyValue, HasNoiseOfTheSizeThatIsAskedFor) {
  Faulty<JointReading> noisy("encoder1:noise@0:0.01");
  Faulty<JointReading> dithered("encoder1:stuck@0:0.01");
  double of_noisy = 0.0, of_dithered = 0.0;
  constexpr int ticks = 20000;
  for (int tick = 0; tick < ticks; ++tick) {
    of_noisy += std::pow(noisy.told(joints(tick)).active[0] - joints(tick).active[0], 2);
    of_dithered += std::pow(dithered.told(joints(tick)).active[0] - joints(0).active[0], 2);
  }
  EXPECT_NEAR(std::sqrt(of_noisy / ticks), 0.01, 2e-4);
  EXPECT_NEAR(std::sqrt(of_dithered / ticks), 0.01, 2e-4);
}

TEST(FaultyValue, IsIntermittentInTheShareThatIsAskedFor) {
  Faulty<DriveReading> faulty("currents:intermittent@0:0.3");
  int lost = 0;
  for (int tick = 0; tick < 10000; ++tick) {
    const DriveReading reading{
        .acquired = Time(1ms) * tick, .valid = true, .current = Eigen::Vector3d::Ones()};
    lost += faulty.told(reading).valid ? 0 : 1;
  }
  EXPECT_NEAR(lost, 3000, 150);
}

TEST(FaultyValue, OfALinkLeavesTheStampsTrue) {
  const std::vector<JointReading> late = told("link:delayed@0.005:0.003");
  EXPECT_EQ(late[4].acquired, 4ms);
  EXPECT_EQ(late[7].acquired, 4ms);
  EXPECT_EQ(late[7].active, joints(4).active);
  const std::vector<JointReading> cut = told("link:off@0.005");
  EXPECT_EQ(cut[9].acquired, 4ms) << "nothing new arrives";
  EXPECT_TRUE(cut[9].valid) << "what had arrived is not touched";
}

TEST(FaultyValue, OfADriveChangesWhatItIsCommanded) {
  const TorqueCommand wanted{.computed = 3ms, .valid = true, .torque = Eigen::Vector3d(1.0, 2.0, 3.0)};
  const auto made_of = [&](const char* fault) { return Faulty<TorqueCommand>(fault).told(wanted); };
  EXPECT_EQ(made_of("drive2:off@0").torque, Eigen::Vector3d(1.0, 0.0, 3.0));
  EXPECT_TRUE(made_of("drive2:off@0").valid);
  EXPECT_EQ(made_of("drive2:stuck@0:50").torque, Eigen::Vector3d(1.0, 50.0, 3.0));
  EXPECT_EQ(made_of("drives:reversed@0").torque, Eigen::Vector3d(-1.0, -2.0, -3.0));
}

TEST(FaultyValue, OfAStatusRepeatsItUnderFreshStamps) {
  Faulty<StationStatus> faulty("status:stuck@0.001");
  faulty.told({.acquired = 0ms, .valid = true, .enabled = false});
  faulty.told({.acquired = 1ms, .valid = true, .enabled = true});
  const StationStatus status = faulty.told({.acquired = 2ms, .valid = true, .enabled = false});
  EXPECT_TRUE(status.enabled);
  EXPECT_EQ(status.acquired, 2ms);
}

TEST(FaultyValue, OfAnImuTouchesItsPart) {
  const ImuReading truth{.acquired = 0ms,
                         .valid = true,
                         .angular_velocity = Eigen::Vector3d(1.0, 2.0, 3.0),
                         .specific_force = Eigen::Vector3d(4.0, 5.0, 6.0)};
  const ImuReading turned = Faulty<ImuReading>("gyroscope3:wrong@0:0.5").told(truth);
  EXPECT_EQ(turned.angular_velocity, Eigen::Vector3d(1.0, 2.0, 3.5));
  EXPECT_EQ(turned.specific_force, truth.specific_force);
  const ImuReading both = Faulty<ImuReading>("imu:reversed@0").told(truth);
  EXPECT_EQ(both.angular_velocity, -truth.angular_velocity);
  EXPECT_EQ(both.specific_force, -truth.specific_force);
  const ImuReading full = Faulty<ImuReading>("accelerometer:saturated@0:4.5").told(truth);
  EXPECT_EQ(full.specific_force, Eigen::Vector3d(4.0, 4.5, 4.5));
  EXPECT_EQ(full.angular_velocity, truth.angular_velocity);
}

/// What was seen along one axis is seen along another: a third of a turn about the middle of all.
TEST(FaultyValue, OfAnImuTurnsItsAxes) {
  const ImuReading truth{.acquired = 0ms,
                         .valid = true,
                         .angular_velocity = Eigen::Vector3d(1.0, 2.0, 3.0),
                         .specific_force = Eigen::Vector3d(4.0, 5.0, 6.0)};
  const ImuReading third = Faulty<ImuReading>("imu:turned@0:2.0943951023931953").told(truth);
  EXPECT_LT((third.angular_velocity - Eigen::Vector3d(2.0, 3.0, 1.0)).norm(), 1e-12);
  EXPECT_LT((third.specific_force - Eigen::Vector3d(5.0, 6.0, 4.0)).norm(), 1e-12);
  const ImuReading quarter = Faulty<ImuReading>("imu3:turned@0:1.5707963267948966").told(truth);
  EXPECT_LT((quarter.specific_force - Eigen::Vector3d(5.0, -4.0, 6.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace flinch
