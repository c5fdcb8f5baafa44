#include "systems/laws/braking_monitor.h"

#include <gtest/gtest.h>

#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

struct Watch {
  explicit Watch(double max_torque = 70.0) {
    PoseConstraints limits;
    limits.max_condition_number = 15.0;
    block = &builder.add<BrakingMonitor>("braking", test::planar_rig(), limits, max_torque);
    reaction = builder.export_input("reaction", block->reaction);
    motion = builder.export_input("motion", block->motion);
    ticking.emplace(builder);
    move({1.0, 0, 0});
    be(ReactionMode::nominal, ReactionMode::stopped);
  }
  void move(const Eigen::Vector3d& velocity, PlatformMotion::Status status = PlatformMotion::Status::valid) {
    ticking->set(motion, PlatformMotion{{}, status, Eigen::Vector3d(0.02, 0.0, 0.0), velocity});
  }
  void be(ReactionMode mode, ReactionMode previous) {
    ticking->set(reaction, ReactionState{mode, previous, ticking->now()});
  }
  const BrakingStatus& tick() {
    ticking->tick();
    return ticking->get(block->status);
  }

  DiagramBuilder builder{"test", 1ms};
  BrakingMonitor* block = nullptr;
  InputPort<ReactionState> reaction;
  InputPort<PlatformMotion> motion;
  std::optional<test::Ticking> ticking;
};

TEST(BrakingMonitor, JudgesTheStateAtTheDetectionAndKeepsThat) {
  for (const ReactionMode mode : {ReactionMode::react, ReactionMode::zero_g}) {
    Watch watch;
    EXPECT_FALSE(watch.tick().valid);
    watch.be(mode, ReactionMode::nominal);
    const BrakingStatus judged = watch.tick();
    EXPECT_TRUE(judged.valid && judged.stays_inside);
    EXPECT_EQ(judged.judged, 1ms);
    EXPECT_GT(judged.duration, 0.0);
    watch.move({30.0, 0, 0});
    EXPECT_EQ(watch.tick().duration, judged.duration);
  }
}

TEST(BrakingMonitor, TellsARobotThatIsTooFastToStopInside) {
  Watch watch;
  watch.tick();
  watch.move({12.0, 0, 0});
  watch.be(ReactionMode::react, ReactionMode::nominal);
  const BrakingStatus& judged = watch.tick();
  EXPECT_TRUE(judged.valid);
  EXPECT_FALSE(judged.stays_inside);
}

TEST(BrakingMonitor, TellsNoDurationWhereNoStopIsPossible) {
  Watch watch(1e-6);
  watch.tick();
  watch.be(ReactionMode::react, ReactionMode::nominal);
  const BrakingStatus& judged = watch.tick();
  EXPECT_TRUE(judged.valid);
  EXPECT_FALSE(judged.stays_inside);
  EXPECT_EQ(judged.duration, std::numeric_limits<double>::infinity());
}

TEST(BrakingMonitor, SaysNothingWithoutAMotion) {
  Watch watch;
  watch.tick();
  watch.move({1.0, 0, 0}, PlatformMotion::Status::no_data);
  watch.be(ReactionMode::react, ReactionMode::nominal);
  EXPECT_FALSE(watch.tick().valid);
}

TEST(BrakingMonitor, NeverAllocates) {
  Watch watch;
  watch.tick();
  watch.be(ReactionMode::react, ReactionMode::nominal);
  const test::AllocationCounter counter;
  watch.tick(), watch.tick();
  EXPECT_EQ(counter.count(), 0);
}

TEST(BrakingMonitor, RefusesATorqueThatIsNotPositive) {
  EXPECT_THROW(BrakingMonitor(test::planar_rig(), {}, 0.0), SetupError);
}

}  // namespace
}  // namespace flinch
