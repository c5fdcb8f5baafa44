#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "tests/drivers/link_ends.h"
#include "tests/support/free_domain.h"
#include "tests/support/other_program.h"

namespace flinch {
namespace {

using test::FarEnd;
using test::NearEnd;
using test::OtherProgram;

OtherProgram far_program(std::uint32_t domain) {
  return OtherProgram([domain] {
    const DdsBus bus({.domain = domain});
    FarEnd far(bus);
    far.run([] { return false; });
  });
}

OtherProgram near_program(std::uint32_t domain) {
  return OtherProgram([domain] {
    const DdsBus bus({.domain = domain});
    NearEnd near(bus);
    near.run([] { return false; });
  });
}

TEST(TwoPrograms, BringReadingsOneWayAndTorquesTheOther) {
  const std::uint32_t domain = test::free_domain();
  const OtherProgram other = far_program(domain);
  const DdsBus bus({.domain = domain});
  NearEnd near(bus);
  std::vector<double> round_trips;  // [us]
  near.run([&] {
    const JointReading& joints = near.get(near.station().joints);
    if (joints.valid) {
      EXPECT_NEAR(joints.active[2], 3.0 * joints.active[0], 1e-12);
    }
    const DdsLink link = near.dds().link();
    if (link.commands_obeyed) round_trips.push_back(1e6 * to_seconds(link.round_trip));
    return round_trips.size() == 3000 || near.time() > 60s;
  });
  ASSERT_EQ(round_trips.size(), 3000u);
  std::sort(round_trips.begin(), round_trips.end());
  std::cout << "round trip [us]: p50 " << round_trips[1500] << ", p99 " << round_trips[2970] << ", p99.9 "
            << round_trips[2997] << ", most " << round_trips.back() << std::endl;
  EXPECT_GT(round_trips.front(), 0.0);
}

/// What the far end does about a commander that goes away in mid-run.
struct Silence {
  bool begun = false;
  Time last_release{};  ///< the last tick that let the brakes be open
  Time last_sent{};     ///< stamp of the command that it obeyed
  Time braked{};        ///< the tick that closed them
  Time worst_tick{};    ///< between two ticks meanwhile: the machine's part
};

/// Runs the far end until it has obeyed for a while, lets `leave` happen, and until its brakes are closed.
Silence watch_silence(FarEnd& far, const std::function<void()>& leave) {
  Silence silence;
  int obeyed = 0;
  Time previous = MonotonicClock::now();
  far.run([&] {
    const Time now = MonotonicClock::now();
    if (silence.begun) silence.worst_tick = std::max(silence.worst_tick, now - previous);
    previous = now;
    if (!far.brake()) {
      silence.last_release = now;
      silence.last_sent = now - far.server().commander().age;
      if (++obeyed == 300) leave(), silence.begun = true;
    } else if (silence.begun) {
      silence.braked = now;
      return true;
    }
    return false;
  });
  return silence;
}

void expect_brakes_in_time(const Silence& silence) {
  const Time after = silence.braked - silence.last_sent;
  std::cout << "brakes closed " << 1e-6 * static_cast<double>(after.count())
            << " ms after the last command was sent; longest tick of this end "
            << 1e-6 * static_cast<double>(silence.worst_tick.count()) << " ms" << std::endl;
  EXPECT_GT(after, 5ms);
  EXPECT_LE(after, std::max<Time>(10ms, 6ms + silence.worst_tick + 1ms));
}

TEST(TwoPrograms, CloseTheBrakesWithin10MsWhenTheCommanderIsKilled) {
  const std::uint32_t domain = test::free_domain();
  OtherProgram other = near_program(domain);
  const DdsBus bus({.domain = domain});
  FarEnd far(bus);
  expect_brakes_in_time(watch_silence(far, [&] { other.kill(); }));
}

TEST(TwoPrograms, CloseTheBrakesWithin10MsWhenTheCommanderHangsAndLetItBeginAnew) {
  const std::uint32_t domain = test::free_domain();
  OtherProgram other = near_program(domain);
  const DdsBus bus({.domain = domain});
  FarEnd far(bus);
  expect_brakes_in_time(watch_silence(far, [&] { other.stop(); }));
  int silent = 0;
  far.run([&] {
    EXPECT_TRUE(far.brake());
    return ++silent == 100;
  });
  other.resume();
  far.run([&] { return !far.brake(); });
  EXPECT_TRUE(far.torque().valid);
}

}  // namespace
}  // namespace flinch
