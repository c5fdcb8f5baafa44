#include "systems/contact/max_detector.h"

#include <gtest/gtest.h>

#include "tests/support/ticking.h"

namespace flinch {
namespace {

ContactDetection detected(ContactLevel level, Time when, double force) {
  return {.valid = true,
          .level = level,
          .present_level = level,
          .detected = when,
          .wrench_in_base = PlatformVector::Constant(3, force)};
}

ContactDetection either(const ContactDetection& first, const ContactDetection& second) {
  DiagramBuilder builder;
  auto& block = builder.add<MaxDetector>("either");
  const auto one = builder.export_input("one", block.first);
  const auto other = builder.export_input("other", block.second);
  test::Ticking ticking(builder);
  ticking.set(one, first);
  ticking.set(other, second);
  ticking.tick();
  return ticking.get(block.contact);
}

const ContactDetection quiet{.valid = true, .wrench_in_base = {}};

TEST(MaxDetector, SaysWhatOneOfThemSays) {
  const ContactDetection touch = detected(ContactLevel::reaction, 5ms, 2.0);
  for (const ContactDetection& told : {either(touch, quiet), either(quiet, touch)}) {
    EXPECT_EQ(told.level, ContactLevel::reaction);
    EXPECT_EQ(told.present_level, ContactLevel::reaction);
    EXPECT_EQ(told.detected, 5ms);
    EXPECT_EQ(told.wrench_in_base[0], 2.0);
  }
  EXPECT_EQ(either(quiet, quiet).level, ContactLevel::none);
}

TEST(MaxDetector, TakesTheHigherLevelAndTheEarlierTime) {
  const ContactDetection early = detected(ContactLevel::reaction, 5ms, 2.0);
  const ContactDetection hard = detected(ContactLevel::hard, 7ms, 70.0);
  for (const ContactDetection& told : {either(early, hard), either(hard, early)}) {
    EXPECT_EQ(told.level, ContactLevel::hard);
    EXPECT_EQ(told.detected, 5ms);
    EXPECT_EQ(told.wrench_in_base[0], 2.0);
  }
}

TEST(MaxDetector, IsValidAsLongAsOneIs) {
  EXPECT_TRUE(either(quiet, {}).valid);
  EXPECT_TRUE(either({}, quiet).valid);
  EXPECT_FALSE(either({}, {}).valid);
}

}  // namespace
}  // namespace flinch
