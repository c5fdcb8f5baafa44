#include "diagrams/external_station.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "systems/foundation/setup_error.h"
#include "systems/framework/constant.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

std::shared_ptr<const ParallelRobot> rig() {
  return std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::none));
}

Arrival<JointReading> joints(std::uint32_t number, Time acquired, std::uint32_t source = 9) {
  return {.reading = {.acquired = acquired,
                      .valid = true,
                      .passive_valid = true,
                      .active = JointVector::Constant(3, static_cast<double>(number)),
                      .passive = JointVector::Constant(3, 0.5)},
          .source = source,
          .number = number};
}

/// A station whose joint readings the test brings in, tick by tick.
class Outside {
 public:
  explicit Outside(const ExternalStationSettings& settings = {}) {
    DiagramBuilder builder("outside");
    station_ = add_external_station(builder, rig(), settings);
    builder.connect(builder.add<Constant<TorqueCommand>>("torque", TorqueCommand()).value,
                    station_.torque_command);
    builder.connect(builder.add<Constant<BrakeCommand>>("brake", BrakeCommand()).value, station_.brake);
    diagram_ = builder.build();
    context_ = std::make_unique<Context>(diagram_->make_context());
  }

  /// The flow at the next tick, nothing new having come.
  Flow tick() {
    context_->set_time(now_);
    diagram_->evaluate(*context_);
    diagram_->update(*context_);
    now_ += 1ms;
    return link().flow;
  }
  /// The flow at the next tick, to which a reading has come.
  Flow tick(const Arrival<JointReading>& arrival) {
    context_->set(station_.arriving_joints, arrival);
    return tick();
  }

  const JointReading& reading() const { return context_->get(station_.joints); }
  const LinkStatus& link() const { return context_->get(station_.joints_link); }
  bool any_other_valid() const {
    return context_->get(station_.drives).valid || context_->get(station_.imu).valid ||
           context_->get(station_.status).valid;
  }

 private:
  ExternalStation station_;
  std::unique_ptr<Diagram> diagram_;
  std::unique_ptr<Context> context_;
  Time now_ = 1s;
};

TEST(ExternalStation, HasNothingValidBeforeAnythingCame) {
  Outside outside;
  EXPECT_EQ(outside.tick(), Flow::nothing);
  EXPECT_FALSE(outside.reading().valid);
  EXPECT_FALSE(outside.any_other_valid());
}

TEST(ExternalStation, ShowsAFreshReadingAsItCame) {
  Outside outside;
  EXPECT_EQ(outside.tick(joints(1, 999ms)), Flow::fresh);
  EXPECT_TRUE(outside.reading().valid);
  EXPECT_TRUE(outside.reading().passive_valid);
  EXPECT_EQ(outside.reading().active, JointVector::Constant(3, 1.0));
  EXPECT_EQ(outside.reading().acquired, 999ms);
  EXPECT_EQ(outside.link().age, 1ms);
}

TEST(ExternalStation, LivesOnTheLastReadingUntilItIsTooOld) {
  Outside outside;
  outside.tick(joints(1, 999ms));             // 1000 ms: 1 ms old
  EXPECT_EQ(outside.tick(), Flow::repeated);  // 2 ms
  EXPECT_EQ(outside.tick(), Flow::repeated);  // 3 ms
  EXPECT_TRUE(outside.reading().valid);
  EXPECT_EQ(outside.tick(), Flow::stale);  // 4 ms
  EXPECT_FALSE(outside.reading().valid);
  EXPECT_EQ(outside.tick(joints(5, 1003ms)), Flow::fresh);
  EXPECT_TRUE(outside.reading().valid);
}

TEST(ExternalStation, DoesNotTakeANewReadingForAYoungOne) {
  Outside outside;
  EXPECT_EQ(outside.tick(joints(1, 990ms)), Flow::stale);
  EXPECT_FALSE(outside.reading().valid);
}

TEST(ExternalStation, CountsWhatItHasNotSeen) {
  Outside outside;
  outside.tick(joints(0xfffffffe, 999ms));
  EXPECT_EQ(outside.tick(joints(3, 1000ms)), Flow::fresh);
  EXPECT_EQ(outside.link().skipped, 4u);
  EXPECT_TRUE(outside.reading().valid);
}

TEST(ExternalStation, DoesNotGoBackToAnOlderReading) {
  Outside outside;
  outside.tick(joints(5, 999ms));
  EXPECT_EQ(outside.tick(joints(4, 998ms)), Flow::out_of_order);
  EXPECT_EQ(outside.reading().active[0], 5.0);
  EXPECT_TRUE(outside.reading().valid);
  EXPECT_EQ(outside.tick(joints(6, 1001ms)), Flow::fresh);
}

TEST(ExternalStation, DoesNotLetARepeatedNumberRefreshTheReading) {
  Outside outside;
  outside.tick(joints(5, 999ms));
  for (Time t = 1000ms; t < 1003ms; t += 1ms) outside.tick(joints(5, t));
  EXPECT_FALSE(outside.reading().valid);
}

TEST(ExternalStation, MarksBrokenValuesAndRecovers) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Outside outside;
    outside.tick(joints(1, 999ms));
    Arrival<JointReading> broken = joints(2, 1000ms);
    broken.reading.active[1] = bad;
    EXPECT_EQ(outside.tick(broken), Flow::broken);
    EXPECT_FALSE(outside.reading().valid);
    EXPECT_TRUE(outside.reading().active.allFinite());
    EXPECT_EQ(outside.tick(), Flow::repeated);
    EXPECT_FALSE(outside.reading().valid);
    EXPECT_EQ(outside.tick(joints(3, 1002ms)), Flow::fresh);
    EXPECT_TRUE(outside.reading().valid);
  }
}

TEST(ExternalStation, MarksAReadingOfAnotherRobotsSize) {
  Outside outside;
  Arrival<JointReading> other = joints(1, 999ms);
  other.reading.active = JointVector::Zero(6);
  EXPECT_EQ(outside.tick(other), Flow::broken);
  EXPECT_FALSE(outside.reading().valid);
}

TEST(ExternalStation, DistrustsBrokenPassiveAnglesAlone) {
  Outside outside;
  Arrival<JointReading> half = joints(1, 999ms);
  half.reading.passive[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(outside.tick(half), Flow::fresh);
  EXPECT_TRUE(outside.reading().valid);
  EXPECT_FALSE(outside.reading().passive_valid);
}

TEST(ExternalStation, MarksTimesThatJumpAndIsNotMisledByThem) {
  Outside outside;
  outside.tick(joints(1, 999ms));
  EXPECT_EQ(outside.tick(joints(2, 50s)), Flow::broken);
  EXPECT_FALSE(outside.reading().valid);
  EXPECT_EQ(outside.tick(joints(3, 1002ms)), Flow::fresh);
  EXPECT_EQ(outside.tick(joints(4, 1001ms)), Flow::broken);
  EXPECT_EQ(outside.tick(joints(5, 1004ms)), Flow::fresh);
  EXPECT_TRUE(outside.reading().valid);
}

TEST(ExternalStation, BeginsAnewWithAnotherSourceAfterOneInvalidReading) {
  Outside outside;
  outside.tick(joints(700, 999ms));
  EXPECT_EQ(outside.tick(joints(1, 1000ms, 10)), Flow::restarted);
  EXPECT_FALSE(outside.reading().valid);
  EXPECT_EQ(outside.tick(joints(2, 1001ms, 10)), Flow::fresh);
  EXPECT_TRUE(outside.reading().valid);
}

TEST(ExternalStation, DoesNotMakeAnInvalidReadingValid) {
  Outside outside;
  Arrival<JointReading> invalid = joints(1, 999ms);
  invalid.reading.valid = false;
  EXPECT_EQ(outside.tick(invalid), Flow::fresh);
  EXPECT_FALSE(outside.reading().valid);
}

TEST(ExternalStation, NeverAllocates) {
  Outside outside;
  const test::AllocationCounter counter;
  for (std::uint32_t k = 1; k < 50; ++k) outside.tick(joints(k, 999ms + k * 1ms));
  EXPECT_EQ(counter.count(), 0);
}

TEST(ExternalStation, RefusesAgesThatLetNothingIn) {
  DiagramBuilder builder;
  EXPECT_THROW(add_external_station(builder, rig(), {.max_age = 0ms}), SetupError);
}

TEST(ExternalStation, ShowsAllButBrokenReadingsAsTheyAreInLockstep) {
  Outside outside({.lockstep = true});
  EXPECT_EQ(outside.tick(joints(1, 1s)), Flow::fresh);
  EXPECT_EQ(outside.tick(joints(2, 900ms)), Flow::fresh) << "a sensor that is late, or stands";
  EXPECT_TRUE(outside.reading().valid);
  EXPECT_EQ(outside.reading().acquired, 900ms);
  EXPECT_EQ(outside.reading().active, JointVector::Constant(3, 2.0));
  EXPECT_EQ(outside.tick(joints(40, 900ms)), Flow::fresh);
  EXPECT_EQ(outside.link().skipped, 0U) << "the numbers count what was sent again";

  Arrival<JointReading> none = joints(41, 1003ms);
  none.reading.valid = false;
  EXPECT_EQ(outside.tick(none), Flow::fresh);
  EXPECT_FALSE(outside.reading().valid);
  EXPECT_EQ(outside.reading().active, JointVector::Constant(3, 41.0));

  Arrival<JointReading> of_another_robot = joints(42, 1004ms);
  of_another_robot.reading.active = JointVector::Zero(2);
  EXPECT_EQ(outside.tick(of_another_robot), Flow::broken);
  EXPECT_FALSE(outside.reading().valid);
  EXPECT_EQ(outside.reading().active.size(), 3);
}

}  // namespace
}  // namespace flinch
