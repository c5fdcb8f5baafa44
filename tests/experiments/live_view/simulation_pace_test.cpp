#include "experiments/live_view/simulation_pace.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace flinch {
namespace {

using Clock = std::chrono::steady_clock;

/// How long a hundred ticks of 1 ms take [s].
double seconds_for_a_hundred_ticks(SimulationPace& pace) {
  const auto begin = Clock::now();
  for (int tick = 0; tick <= 100; ++tick) pace.wait_until(tick * 1ms);
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

TEST(SimulationPace, IsNeverFasterThanWanted) {
  for (const double speed : {0.2, 1.0, 5.0}) {
    SimulationPace pace(speed);
    const double seconds = seconds_for_a_hundred_ticks(pace);
    EXPECT_GE(seconds, 0.1 / speed - 0.0005) << speed;
    EXPECT_LT(seconds, 0.1 / speed + 2.0) << speed;
  }
}

TEST(SimulationPace, DoesNotMakeUpForLostTime) {
  SimulationPace pace(1.0);
  pace.wait_until(0ms);
  std::this_thread::sleep_for(300ms);
  pace.wait_until(1ms);  // late
  const auto begin = Clock::now();
  pace.wait_until(101ms);
  EXPECT_GE(Clock::now() - begin, 95ms);
}

TEST(SimulationPace, TakesOneTickForEachOrderWhileItIsPaused) {
  SimulationPace pace(100.0);
  EXPECT_TRUE(pace.follow("pause"));
  std::atomic<int> ticks = 0;
  std::thread simulation([&] {
    for (int tick = 0; tick < 50; ++tick, ++ticks) pace.wait_until(tick * 1ms);
  });
  const auto settles_at = [&ticks](int wanted) {
    for (int i = 0; i < 400 && ticks < wanted; ++i) std::this_thread::sleep_for(5ms);
    std::this_thread::sleep_for(50ms);
    return ticks.load();
  };
  EXPECT_EQ(settles_at(0), 0);
  EXPECT_TRUE(pace.follow("tick"));
  EXPECT_EQ(settles_at(1), 1);
  pace.follow("tick");
  pace.follow("tick");
  EXPECT_EQ(settles_at(3), 3);
  EXPECT_TRUE(pace.state().paused);
  EXPECT_TRUE(pace.follow("go"));
  simulation.join();
  EXPECT_EQ(ticks, 50);
}

TEST(SimulationPace, PausesAtATick) {
  SimulationPace pace(1.0);
  EXPECT_TRUE(pace.follow("tick"));
  EXPECT_TRUE(pace.state().paused);
}

TEST(SimulationPace, ReleasesWhoWaits) {
  SimulationPace pace(0.001);
  std::thread simulation([&pace] {
    for (int tick = 0; tick < 1000; ++tick) pace.wait_until(tick * 1s);
  });
  std::this_thread::sleep_for(20ms);
  pace.release();
  simulation.join();
}

TEST(SimulationPace, RefusesWhatIsNoOrder) {
  SimulationPace pace(0.5);
  for (const char* text : {"", "fly", "speed", "speed ", "speed 0", "speed -1", "speed nan", "speed inf",
                           "speed 1e9", "speed 1 2", "speed 0x1", "pause now", " pause"}) {
    EXPECT_FALSE(pace.follow(text)) << text;
  }
  EXPECT_EQ(pace.state(), (PaceState{0.5, false}));
  EXPECT_TRUE(pace.follow("speed 2"));
  EXPECT_EQ(pace.state(), (PaceState{2.0, false}));
}

}  // namespace
}  // namespace flinch
