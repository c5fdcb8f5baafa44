#include "plant/contact_history.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flinch {
namespace {

NearPairs pairs_of(double first_gap, double first_rate, double second_gap = 1.0, double second_rate = 0.0) {
  NearPairs near;
  near.add({.body = 2, .obstacle = 0, .gap = first_gap, .rate = first_rate});
  near.add({.body = 5, .obstacle = 1, .gap = second_gap, .rate = second_rate});
  return near;
}

ContactForces pushing(double force) {
  ContactForces contacts;
  contacts.touch_count = 1;
  contacts.touches[0] = {2, 0, {0.0, 0.0, 0.0}, {0.0, force, 0.0}, 0.0, false};
  return contacts;
}

TEST(HermiteCrossing, IsExactForCubics) {
  const auto cubic = [](double t) { return 2.0 - 3.0 * t - 40.0 * t * t - 700.0 * t * t * t; };
  const auto rate = [](double t) { return -3.0 - 80.0 * t - 2100.0 * t * t; };
  for (const double duration : {0.13, 0.2, 0.4}) {
    const double crossing =
        hermite_crossing(cubic(0.0), rate(0.0), cubic(duration), rate(duration), duration);
    EXPECT_NEAR(cubic(crossing), 0.0, 1e-10);
  }
}

TEST(HermiteCrossing, FindsRisingCrossingsToo) {
  EXPECT_NEAR(hermite_crossing(-1e-4, 0.4, 3e-4, 0.4, 1e-3), 0.25e-3, 1e-12);
}

TEST(HermiteCrossing, OfABallInFreeFallIsItsFlightTime) {
  const double fall = std::sqrt(2.0 * 4e-6 / 9.81);
  const double t = 1e-3;
  EXPECT_NEAR(hermite_crossing(4e-6, 0.0, 4e-6 - 0.5 * 9.81 * t * t, -9.81 * t, t), fall, 1e-13);
}

TEST(ContactHistory, TellsOnsetPeakAndEndOfAContact) {
  ContactHistory history;
  const ContactForces none;
  history = history.next(0ms, pairs_of(0.75e-3, -1.0), none);
  EXPECT_FALSE(history.in_contact);
  EXPECT_EQ(history.contacts, 0);

  history = history.next(1ms, pairs_of(-0.25e-3, -1.0), pushing(3.0));
  EXPECT_TRUE(history.in_contact);
  EXPECT_EQ(history.contacts, 1);
  EXPECT_EQ(history.onset, 750us);
  EXPECT_EQ(history.end, 1ms);

  history = history.next(2ms, pairs_of(-0.5e-3, 0.2), pushing(8.0));
  history = history.next(3ms, pairs_of(-0.3e-3, 0.5), pushing(5.0));
  EXPECT_EQ(history.onset, 750us);
  EXPECT_EQ(history.end, 3ms);
  EXPECT_EQ(history.peak_force, 8.0);

  history = history.next(4ms, pairs_of(0.2e-3, 0.5), none);
  EXPECT_FALSE(history.in_contact);
  EXPECT_EQ(history.end, 3600us);
  EXPECT_EQ(history.peak_force, 8.0);
  EXPECT_EQ(history.onset, 750us);

  history = history.next(5ms, pairs_of(-0.1e-3, -0.3), pushing(1.0));
  EXPECT_EQ(history.contacts, 2);
  EXPECT_EQ(history.onset, 4ms + Time(772936)) << "8 s^3 - 16 s^2 + 5 s + 2 = 0 on the way back";
  EXPECT_EQ(history.peak_force, 1.0);
}

TEST(ContactHistory, LastsFromTheFirstBodyToTheLast) {
  for (const bool swapped : {false, true}) {
    const auto gaps = [&](double a, double a_rate, double b, double b_rate) {
      return swapped ? pairs_of(b, b_rate, a, a_rate) : pairs_of(a, a_rate, b, b_rate);
    };
    ContactHistory history;
    const ContactForces none;
    history = history.next(0ms, gaps(0.8e-3, -1.0, 0.4e-3, -1.0), none);
    history = history.next(1ms, gaps(-0.2e-3, -1.0, -0.6e-3, -1.0), pushing(1.0));
    EXPECT_EQ(history.onset, 400us);
    history = history.next(2ms, gaps(-0.2e-3, 0.5, -0.1e-3, 0.5), pushing(1.0));
    EXPECT_TRUE(history.in_contact);
    EXPECT_EQ(history.contacts, 1);
    history = history.next(3ms, gaps(0.3e-3, 0.5, 0.4e-3, 0.5), none);
    EXPECT_EQ(history.end, 2400us);
  }
}

TEST(ContactHistory, ThatStartsInContactBeginsWithTheFirstTick) {
  ContactHistory history;
  history = history.next(5ms, pairs_of(-1e-3, 0.0), pushing(2.0));
  EXPECT_TRUE(history.in_contact);
  EXPECT_EQ(history.onset, 5ms);
}

}  // namespace
}  // namespace flinch
