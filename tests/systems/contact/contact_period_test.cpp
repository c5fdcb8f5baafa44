#include "systems/contact/contact_period.h"

#include <gtest/gtest.h>

#include "systems/foundation/setup_error.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

struct Period {
  Period()
      : block(builder.add<ContactPeriod>("period", 5ms)),
        detection(builder.export_input("detection", block.detection)),
        reset(builder.export_input("reset", block.reset)),
        ticking(builder) {}

  const ContactPhase& see(bool detected, bool reset_now = false) {
    ContactDetection contact;
    contact.valid = true;
    contact.present_level = detected ? ContactLevel::reaction : ContactLevel::none;
    ticking.set(detection, contact);
    ticking.set(reset, ResetCommand{reset_now});
    ticking.tick();
    return ticking.get(block.phase);
  }

  DiagramBuilder builder;
  ContactPeriod& block;
  InputPort<ContactDetection> detection;
  InputPort<ResetCommand> reset;
  test::Ticking ticking;
};

TEST(ContactPeriod, BeginsAtTheTickAtWhichTheDetectorNotices) {
  Period period;
  EXPECT_FALSE(period.see(false).active);
  const ContactPhase phase = period.see(true);
  EXPECT_TRUE(phase.active);
  EXPECT_EQ(phase.since, 1ms);
  EXPECT_TRUE(phase.begins(1ms));
  EXPECT_FALSE(phase.begins(2ms));
}

TEST(ContactPeriod, LastsOverShortPausesAndEndsAfterLongOnes) {
  Period period;
  period.see(true);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(period.see(false).active);
  EXPECT_EQ(period.see(true).since, Time{});
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(period.see(false).active);
  EXPECT_FALSE(period.see(false).active);
  EXPECT_EQ(period.see(true).since, 13ms);
}

TEST(ContactPeriod, EndsAtTheResetAndBeginsAnewWhereTheTouchLasts) {
  Period period;
  period.see(true);
  EXPECT_FALSE(period.see(false, true).active);
  period.see(true);
  EXPECT_EQ(period.see(true, true).since, 3ms);
}

TEST(ContactPeriod, HasNoNegativeTime) { EXPECT_THROW(ContactPeriod(-1ms), SetupError); }

}  // namespace
}  // namespace flinch
