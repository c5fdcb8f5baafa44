#include "diagrams/control_rate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "diagrams/contact_control.h"
#include "diagrams/robot_settings.h"
#include "systems/config/robot_file.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const RobotFile& rig() {
  static const RobotFile file = read_robot_file(FLINCH_SOURCE_DIR "/apps/robots/planar_3rrr.yaml");
  return file;
}

ContactControlSettings settings_at(Time period) {
  return settings_for(*rig().robot, rig().drives, rig().limits, period);
}

TEST(ControlRate, SuitsTheDefaultsAtEveryPeriod) {
  for (const Time period : {250us, 400us, 500us, 1000us, 1500us, 2000us, 3333us, 4000us}) {
    EXPECT_TRUE(too_fast_for_rate(settings_at(period)).empty()) << period.count();
    DiagramBuilder builder("loop", period);
    EXPECT_NO_THROW(add_contact_control(builder, rig().robot, settings_at(period))) << period.count();
  }
}

TEST(ControlRate, IsTwiceThatOfTheFastestFilter) {
  ContactControlSettings settings = settings_at(4ms);
  settings.velocity_filter.low_pass.cutoff_frequency = 125.0;
  EXPECT_TRUE(too_fast_for_rate(settings).empty());
  settings.velocity_filter.low_pass.cutoff_frequency = 126.0;
  settings.momentum_observer.gain = Eigen::Vector3d(20.0, 1000.0, 20.0);
  const std::vector<TooFast> found = too_fast_for_rate(settings);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].section, "velocity_filter");
  EXPECT_THAT(found[0].complaint,
              HasSubstr("is 126 Hz; with a control period of 4000 us it must be at most 125"));
  EXPECT_EQ(found[1].key, "gain");
  EXPECT_THAT(found[1].complaint, HasSubstr("shorten control_period_us"));
}

TEST(ControlRate, ThatIsTooSlowIsRefusedByTheControlPath) {
  ContactControlSettings settings = settings_at(4ms);
  settings.isolation.observer_gain = 1000.0;
  DiagramBuilder builder("loop", 4ms);
  EXPECT_THAT(test::problems_of([&] { add_contact_control(builder, rig().robot, settings); }),
              ElementsAre(HasSubstr("isolation.observer_gain is 1000 1/s")));
}

TEST(ControlRate, OfAKilohertzIsWhatTheDefaultsAreFor) {
  const ContactControlSettings usual = settings_at(1ms), defaults;
  EXPECT_EQ(usual.velocity_filter.sampling.longest_hold, defaults.velocity_filter.sampling.longest_hold);
  EXPECT_EQ(usual.sliding_mode_observer.substeps, defaults.sliding_mode_observer.substeps);
  EXPECT_EQ(usual.imu_residual.rest_in_a_row, defaults.imu_residual.rest_in_a_row);
  EXPECT_EQ(usual.imu_residual.leaving_rest, defaults.imu_residual.leaving_rest);
  EXPECT_EQ(usual.imu_residual.rest_samples, defaults.imu_residual.rest_samples);
  EXPECT_EQ(usual.faults.longest_gap, defaults.faults.longest_gap);
  EXPECT_EQ(usual.faults.max_age, defaults.faults.max_age);
  EXPECT_EQ(usual.faults.max_torque_jump, defaults.faults.max_torque_jump);
}

TEST(ControlRate, ChangesCountsOfTicksSoThatTheirTimesStay) {
  const ContactControlSettings slow = settings_at(4ms), fast = settings_at(250us);
  EXPECT_EQ(slow.sliding_mode_observer.substeps, 40);
  EXPECT_EQ(fast.sliding_mode_observer.substeps, 3);
  EXPECT_EQ(slow.imu_residual.rest_samples, 13);
  EXPECT_EQ(fast.imu_residual.rest_samples, 200);
  EXPECT_EQ(slow.faults.longest_gap, 4ms) << "one reading may be missing";
  EXPECT_EQ(fast.faults.longest_gap, 2ms);
  EXPECT_EQ(slow.faults.max_age, 8ms);
  EXPECT_EQ(fast.contact_detector.period, 250us);
}

}  // namespace
}  // namespace flinch
