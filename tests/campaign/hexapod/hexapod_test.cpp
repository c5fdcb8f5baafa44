// What a hexapod detects: in free motion, of contacts of its platform, and with drives that rub unevenly: 8
// contacts of each sort. FLINCH_CONTACTS in the environment says how many instead. The tables are printed;
// docs/theory.md cites those of 20.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "tests/experiments/simulated/hexapod_trials.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::ContactOutcome;
using test::KnownFriction;
using test::PlatformContact;
using test::Stiffness;

const int trials = test::wanted("FLINCH_CONTACTS", 8);

TEST(Hexapod, NoticesNothingInFreeMotion) {
  std::printf("  free motion, mechanics as modelled, all noise: estimate (limit 10 N, 1 Nm)\n");
  std::printf("  motion      s       N      Nm   tracking mm   deg\n");
  double force = 0.0, moment = 0.0;
  for (int trial = 1; trial <= trials; ++trial) {
    const auto seed = static_cast<std::uint64_t>(trial);
    const Verdict got = test::outcome_of(test::with_free_motion(test::hexapod_trial(seed), seed)).verdict;
    std::printf("  %6d %6.2f %7.2f %7.3f %13.1f %5.2f\n", trial, got.simulated, got.max_observer_error_force,
                got.max_observer_error_moment, 1e3 * got.max_tracking_error,
                180.0 / std::numbers::pi * got.max_orientation_error);
    EXPECT_TRUE(got.good()) << got.failures.front();
    EXPECT_TRUE(got.detections.empty());
    force = std::max(force, got.max_observer_error_force);
    moment = std::max(moment, got.max_observer_error_moment);
  }
  std::printf("  largest %13.2f %7.3f\n", force, moment);
}

double largest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

/// Of contacts.
struct Tally {
  int detected = 0, removed = 0, faults = 0, false_detections = 0;
  std::vector<double> times, best;  // [ms]
  double peak_force = 0.0;          // [N]

  void count(const ContactOutcome& got) {
    EXPECT_TRUE(got.is_platform_alone);
    detected += std::isfinite(got.detected) ? 1 : 0;
    removed += std::isfinite(got.removed) ? 1 : 0;
    faults += got.verdict.fault.empty() ? 0 : 1;
    false_detections += got.verdict.false_detections;
    times.push_back(got.detected);
    best.push_back(got.detected_at_best);
    peak_force = std::max(peak_force, got.peak_force);
  }
  void print(const char* what) const {
    std::printf(
        "  %s: detected %d of %zu, after %.1f ms (median; at best %.1f), at most %.1f ms; removed %d; "
        "faults %d; false %d; peak %.0f N\n",
        what, detected, times.size(), test::median(times), test::median(best), largest(times), removed,
        faults, false_detections, peak_force);
  }
};

void print(const PlatformContact& contact, const ContactOutcome& got) {
  std::printf("  %-8s %5.2f  (%5.2f %5.2f %5.2f) %10.1f %8.1f %8.1f %7.0f\n",
              contact.ball_moves ? "ball" : "platform", contact.speed, contact.direction.x(),
              contact.direction.y(), contact.direction.z(), got.detected, got.detected_at_best, got.removed,
              got.peak_force);
}

Tally collide(Stiffness stiffness) {
  std::printf("  contacts, %d N/mm, limits 10 N and 1 Nm, gain 20 1/s\n", static_cast<int>(stiffness) / 1000);
  std::printf("  moves     m/s  direction          detected ms  at best  removed  peak N\n");
  Tally tally;
  std::uint64_t seed = 0;
  for (const PlatformContact& contact : test::draw_contacts(test::hexapod_trial(1), trials, 1)) {
    const ContactOutcome got =
        test::outcome_of(test::with_contact(test::hexapod_trial(++seed), contact, stiffness));
    print(contact, got);
    tally.count(got);
  }
  tally.print("all");
  EXPECT_EQ(tally.detected, trials);
  EXPECT_EQ(tally.removed, trials);
  EXPECT_EQ(tally.faults, 0);
  EXPECT_EQ(tally.false_detections, 0);
  return tally;
}

// [ISO/TS 15066] A.3.4: hand and fingers.
TEST(Hexapod, NoticesContactsAsStiffAsAHand) {
  EXPECT_LE(test::median(collide(Stiffness::hand).times), 13.0);
}

// The gain alone takes longer than that to detect a force that rises so slowly.
TEST(Hexapod, NoticesSoftContactsAsFastAsItsGainAllows) {
  const Tally got = collide(Stiffness::pad);
  EXPECT_GT(test::median(got.best), 13.0);
  for (std::size_t i = 0; i < got.times.size(); ++i) EXPECT_LE(got.times[i], got.best[i] + 9.0);
}

/// Robots drawn one for each contact: what they estimate in a motion without contact, and their contacts.
struct UnevenDrives {
  std::vector<double> forces, moments;  // [N, Nm]
  int faults = 0;                       // without contact
  Tally hand, pad;

  void print(const char* what) const {
    std::printf(
        "  drives that rub by 0.8 to 1.2 of what is usual, %s: without contact %.1f N, %.2f Nm (median), at "
        "most %.1f N, %.2f Nm; faults %d\n",
        what, test::median(forces), test::median(moments), largest(forces), largest(moments), faults);
    hand.print("75 N/mm");
    pad.print(" 6 N/mm");
  }
};

UnevenDrives collide_with_uneven_drives(KnownFriction known) {
  UnevenDrives got;
  std::uint64_t seed = 0;
  for (const PlatformContact& contact : test::draw_contacts(test::hexapod_trial(1), trials, 1)) {
    ++seed;
    const SimulatedScenario robot = test::with_uneven_drives(test::hexapod_trial(seed), known, seed);
    const Verdict alone = test::outcome_of(test::unheeding(test::with_free_motion(robot, seed))).verdict;
    got.faults += alone.fault.empty() ? 0 : 1;
    got.forces.push_back(alone.max_observer_error_force);
    got.moments.push_back(alone.max_observer_error_moment);
    const SimulatedScenario limited = test::with_limits_above(robot, alone);
    got.hand.count(test::outcome_of(test::with_contact(limited, contact, Stiffness::hand)));
    got.pad.count(test::outcome_of(test::with_contact(limited, contact, Stiffness::pad)));
  }
  return got;
}

TEST(Hexapod, NoticesAllWhereTheFrictionOfEachDriveIsKnown) {
  const UnevenDrives got = collide_with_uneven_drives(KnownFriction::of_each_drive);
  got.print("each compensated as it is");
  EXPECT_LE(largest(got.forces), 13.0);
  EXPECT_LE(largest(got.moments), 2.4);
  EXPECT_EQ(got.faults, 0);
  for (const Tally* tally : {&got.hand, &got.pad}) {
    EXPECT_EQ(tally->detected, trials);
    EXPECT_EQ(tally->removed, trials);
    EXPECT_EQ(tally->faults, 0);
    EXPECT_EQ(tally->false_detections, 0);
  }
}

// What rubs and is not known of looks like a contact, so limits are several times higher and some are missed.
TEST(Hexapod, NoticesMostWhereOnlyTheUsualFrictionIsKnown) {
  const UnevenDrives got = collide_with_uneven_drives(KnownFriction::of_its_make);
  got.print("all compensated as usual");
  EXPECT_LE(test::median(got.forces), 53.0);
  EXPECT_LE(test::median(got.moments), 15.0);
  EXPECT_GE(10 * got.hand.detected, 9 * trials);
  EXPECT_EQ(got.hand.false_detections + got.pad.false_detections, 0);
}

}  // namespace
}  // namespace flinch
