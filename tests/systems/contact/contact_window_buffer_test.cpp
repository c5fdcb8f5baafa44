#include "systems/contact/contact_window_buffer.h"

#include <gtest/gtest.h>

#include <limits>

#include "systems/framework/random.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr int oldest = static_cast<int>(window_ages.back() / 1ms);

PlatformVector squared(int tick) { return Eigen::Vector3d(tick * tick, -2.0 * tick * tick, 0.1 * tick); }
PlatformVector cubed(int tick) { return Eigen::Vector3d(tick * tick * tick, 0.3 * tick, -tick); }

struct Memory {
  explicit Memory(Time window = 1000ms, Time period = 1ms)
      : builder("course", period),
        block(builder.add<ContactWindowBuffer>("memory", window, period)),
        phase(builder.export_input("phase", block.phase)),
        wrench(builder.export_input("wrench", block.wrench)),
        platform(builder.export_input("platform", block.platform)),
        ticking(builder) {
    ticking.set(phase, ContactPhase{true, Time{}});
  }

  void see(int number, bool is_estimated = true, bool moves = true, Time late = Time{}) {
    set(number, is_estimated, moves, late);
    ticking.tick();
  }
  void set(int number, bool is_estimated = true, bool moves = true, Time late = Time{}) {
    ticking.set(wrench, WrenchEstimate{.acquired = ticking.now() - late,
                                       .valid = is_estimated,
                                       .wrench_in_base = squared(number),
                                       .drive_torque = JointVector::Zero(3)});
    ticking.set(platform, PlatformMotion{.acquired = ticking.now() - late,
                                         .status = moves ? PlatformMotion::Status::valid
                                                         : PlatformMotion::Status::no_data,
                                         .pose = Eigen::Vector3d::Zero(),
                                         .velocity = cubed(number)});
  }
  ContactWindow course() { return ticking.get(block.course); }
  WrenchEstimate growth() { return ticking.get(block.growth); }

  DiagramBuilder builder;
  ContactWindowBuffer& block;
  InputPort<ContactPhase> phase;
  InputPort<WrenchEstimate> wrench;
  InputPort<PlatformMotion> platform;
  test::Ticking ticking;
};

TEST(ContactWindowBuffer, KnowsWhatWasThereAtEachAge) {
  Memory memory;
  for (int tick = 0; tick <= 70; ++tick) memory.see(tick);
  const ContactWindow course = memory.course();
  ASSERT_TRUE(course.valid);
  EXPECT_EQ(course.acquired, 70ms);
  for (std::size_t i = 0; i < window_ages.size(); ++i) {
    const int then = 70 - static_cast<int>(window_ages[i] / 1ms);
    EXPECT_EQ(course.moments[i].wrench_in_base, squared(then)) << i;
    EXPECT_EQ(course.moments[i].velocity, cubed(then)) << i;
  }
}

TEST(ContactWindowBuffer, TellsWhatHasComeSinceTheFirstMoment) {
  Memory memory;
  for (int tick = 0; tick <= 70; ++tick) memory.see(tick);
  ASSERT_TRUE(memory.growth().valid);
  EXPECT_EQ(memory.growth().wrench_in_base, squared(70) - squared(70 - oldest));
  EXPECT_EQ(memory.growth().acquired, 70ms);
}

TEST(ContactWindowBuffer, KnowsNoCourseUntilThereIsAPast) {
  Memory memory;
  for (int tick = 0; tick <= 60; ++tick) {
    memory.see(tick);
    EXPECT_EQ(memory.course().valid, tick >= oldest) << tick;
    EXPECT_EQ(memory.growth().valid, tick >= oldest) << tick;
  }
}

TEST(ContactWindowBuffer, DoesNotReachOverWhatWasNotKnown) {
  for (const bool is_estimated : {false, true}) {
    Memory memory;
    for (int tick = 0; tick < 60; ++tick) memory.see(tick);
    memory.see(60, is_estimated, !is_estimated);
    EXPECT_FALSE(memory.course().valid);
    for (int tick = 61; tick < 120; ++tick) {
      memory.see(tick);
      EXPECT_EQ(memory.course().valid, tick >= 61 + oldest) << tick;
    }
  }
}

TEST(ContactWindowBuffer, ComparesTimesOfAcquisitionNotTicks) {
  Memory memory;
  for (int tick = 0; tick < 60; ++tick) memory.see(tick);
  memory.see(59, true, true, 1ms);  // nothing new
  EXPECT_EQ(memory.course().moments.back().wrench_in_base, squared(59 - oldest));
  memory.see(61);
  ASSERT_TRUE(memory.course().valid);
  EXPECT_EQ(memory.course().moments.back().wrench_in_base, squared(61 - oldest));
}

TEST(ContactWindowBuffer, KnowsTheCourseWhereStampsJitter) {
  for (const Time jitter : {Time(1ns), Time(20us), Time(400us)}) {
    Memory memory;
    RandomGenerator random(7);
    for (int tick = 0; tick < 300; ++tick) {
      memory.see(tick, true, true, static_cast<std::int64_t>(random() % 1000) * jitter / 1000);
      ASSERT_EQ(memory.course().valid, tick >= oldest) << tick << ", jitter " << jitter.count();
      if (tick < oldest) continue;
      for (std::size_t i = 0; i < window_ages.size(); ++i) {
        const int then = tick - static_cast<int>(window_ages[i] / 1ms);
        EXPECT_EQ(memory.course().moments[i].wrench_in_base, squared(then)) << tick;
      }
    }
  }
}

TEST(ContactWindowBuffer, KnowsTheCourseWhereStampsJitterAndATickBringsNothingNew) {
  Memory memory;
  for (int tick = 0; tick < 60; ++tick) memory.see(tick, true, true, tick % 2 * 20us);
  memory.see(59, true, true, 1ms + 20us);
  for (int tick = 61; tick < 120; ++tick) {
    memory.see(tick, true, true, tick % 3 * 10us);
    EXPECT_TRUE(memory.course().valid) << tick;
  }
}

TEST(ContactWindowBuffer, KnowsNoCourseAfterNothingNewCameForLonger) {
  Memory memory;
  for (int tick = 0; tick < 60; ++tick) memory.see(tick);
  for (int tick = 60; tick < 62; ++tick) memory.see(59, true, true, (tick - 59) * 1ms);
  EXPECT_TRUE(memory.course().valid) << "it is that of 59 ms";
  memory.see(62);
  EXPECT_FALSE(memory.course().valid);
}

TEST(ContactWindowBuffer, IsAtRestOutsideOfTheWindow) {
  Memory memory(10ms);
  memory.ticking.set(memory.phase, ContactPhase{false, Time{}});
  for (int tick = 0; tick <= 60; ++tick) memory.see(tick);
  EXPECT_FALSE(memory.course().valid);
  memory.ticking.set(memory.phase, ContactPhase{true, 61ms});
  for (int tick = 61; tick <= 80; ++tick) {
    memory.see(tick);
    EXPECT_EQ(memory.course().acquired, std::min(tick, 71) * 1ms);
  }
}

TEST(ContactWindowBuffer, DoesNotAllocate) {
  Memory memory;
  for (int tick = 0; tick < 60; ++tick) memory.see(tick);
  memory.set(60);
  const test::AllocationCounter allocations;
  memory.ticking.tick();
  EXPECT_EQ(allocations.count(), 0);
}

/// The squares of numbers that lie between ticks lie a little below the straight line between these: by
/// x (1 - x), where x is the share of a tick.
TEST(ContactWindowBuffer, LiesBetweenTicksThatAreLong) {
  Memory memory(1000ms, 4ms);
  for (int tick = 0; tick <= 20; ++tick) memory.see(tick);
  const ContactWindow course = memory.course();
  ASSERT_TRUE(course.valid);
  for (std::size_t i = 0; i < window_ages.size(); ++i) {
    const double tick = 20.0 - to_seconds(window_ages[i]) / 4e-3, share = tick - std::floor(tick);
    EXPECT_NEAR(course.moments[i].wrench_in_base[0], tick * tick + share * (1.0 - share), 1e-9) << i;
  }
}

TEST(ContactWindowBuffer, ReachesAsFarBackWhereTicksAreShort) {
  Memory memory(1000ms, 250us);
  for (int tick = 0; tick <= 200; ++tick) memory.see(tick);
  const ContactWindow course = memory.course();
  ASSERT_TRUE(course.valid);
  EXPECT_NEAR(course.moments.back().wrench_in_base[2], 0.1 * (200 - 45 * 4), 0.2);
}

}  // namespace
}  // namespace flinch
