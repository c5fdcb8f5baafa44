#include "systems/contact/contact_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::shared_ptr<const PlanarRrr> rig() {
  return std::make_shared<PlanarRrr>(rig_robot(RigGeometry::nominal, RigFriction::none));
}

struct Detector {
  explicit Detector(const ContactDetectorSettings& settings = {})
      : block(builder.add<ContactDetector>("detector", rig(), settings)),
        wrench(builder.export_input("wrench", block.wrench)),
        reset(builder.export_input("reset", block.reset)),
        ticking(builder) {}

  const ContactDetection& see(const PlatformVector& estimated, bool valid = true, bool reset_now = false) {
    ticking.set(wrench, {ticking.now(), valid, estimated, JointVector::Zero(3)});
    ticking.set(reset, ResetCommand{reset_now});
    ticking.tick();
    return ticking.get(block.contact);
  }
  const ContactDetection& see_and_reset(const PlatformVector& estimated) {
    return see(estimated, true, true);
  }

  DiagramBuilder builder;
  ContactDetector& block;
  InputPort<WrenchEstimate> wrench;
  InputPort<ResetCommand> reset;
  test::Ticking ticking;
};

const PlatformVector quiet = PlatformVector::Zero(3);
const PlatformVector touch{{0.0, 12.0, 0.0}};
const PlatformVector blow{{70.0, 0.0, 0.0}};

TEST(ContactDetector, JudgesEveryComponentAgainstItsOwnThresholds) {
  const double reaction[] = {10.0, 10.0, 1.0};
  const double hard[] = {60.0, 60.0, 3.0};
  for (int i = 0; i < 3; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      const auto level = [&](double value) {
        return Detector().see(sign * value * PlatformVector::Unit(3, i)).level;
      };
      EXPECT_EQ(level(std::nextafter(reaction[i], 0.0)), ContactLevel::none);
      EXPECT_EQ(level(reaction[i]), ContactLevel::reaction);
      EXPECT_EQ(level(std::nextafter(hard[i], 0.0)), ContactLevel::reaction);
      EXPECT_EQ(level(hard[i]), ContactLevel::hard);
    }
  }
}

TEST(ContactDetector, MayHaveAReactionThresholdForEachComponent) {
  const ContactDetectorSettings settings{
      .reaction = {ComponentBounds({4.0, 20.0}), 0.5}, .hard = {60.0, 3.0}, .period = 1ms};
  const double reaction[] = {4.0, 20.0, 0.5};
  for (int i = 0; i < 3; ++i) {
    const auto level = [&](double value) {
      return Detector(settings).see(-value * PlatformVector::Unit(3, i)).level;
    };
    EXPECT_EQ(level(std::nextafter(reaction[i], 0.0)), ContactLevel::none);
    EXPECT_EQ(level(reaction[i]), ContactLevel::reaction);
  }
}

TEST(ContactDetector, RefusesThresholdsThatDoNotFit) {
  const auto made = [](const ReactionThreshold& reaction) {
    Detector({.reaction = reaction, .hard = {60.0, 3.0}, .period = 1ms});
  };
  EXPECT_THROW(made({ComponentBounds({4.0, 4.0, 4.0}), 1.0}), SetupError) << "it moves along two axes";
  EXPECT_THROW(made({4.0, ComponentBounds({1.0, 1.0})}), SetupError);
  EXPECT_THROW(made({ComponentBounds({4.0, 0.0}), 1.0}), SetupError);
  EXPECT_THROW(made({ComponentBounds({4.0, 61.0}), 1.0}), SetupError) << "harder than hard";
}

TEST(ContactDetector, LooksAtComponentsNotAtTheirNorm) {
  EXPECT_EQ(Detector().see(PlatformVector{{9.9, 9.9, 0.99}}).level, ContactLevel::none);
}

TEST(ContactDetector, NeverFallsAndKeepsWhatItFirstSaw) {
  RandomGenerator random(1);
  Detector detector;
  ContactLevel highest = ContactLevel::none;
  Time first{};
  PlatformVector at_first;
  for (int k = 0; k < 1000; ++k) {
    const double size = 0.1 * k * random.uniform(0.0, 1.0);
    const PlatformVector estimated =
        PlatformVector::NullaryExpr(3, [&] { return size * random.uniform(-1.0, 1.0); });
    const Time now = detector.ticking.now();
    const ContactDetection& contact = detector.see(estimated);
    if (highest == ContactLevel::none && contact.present_level != ContactLevel::none) {
      first = now;
      at_first = estimated;
    }
    highest = std::max(highest, contact.present_level);
    ASSERT_TRUE(contact.valid);
    ASSERT_EQ(contact.level, highest);
    ASSERT_EQ(contact.detected, first);
    ASSERT_EQ(contact.wrench_in_base.size(), at_first.size());
    if (at_first.size() > 0) {
      ASSERT_EQ(contact.wrench_in_base, at_first);
    }
  }
  EXPECT_EQ(highest, ContactLevel::hard);
}

TEST(ContactDetector, RemembersTheTouchAfterItHasGone) {
  Detector detector;
  detector.see(quiet);
  detector.see(touch);
  const ContactDetection& contact = detector.see(quiet);
  EXPECT_EQ(contact.level, ContactLevel::reaction);
  EXPECT_EQ(contact.present_level, ContactLevel::none);
  EXPECT_EQ(contact.detected, 1ms);
  EXPECT_EQ(contact.wrench_in_base, touch);
}

TEST(ContactDetector, ForgetsOnReset) {
  Detector detector;
  detector.see(blow);
  const ContactDetection& contact = detector.see_and_reset(quiet);
  EXPECT_TRUE(contact.valid);
  EXPECT_EQ(contact.level, ContactLevel::none);
  EXPECT_EQ(contact.detected, Time{});
  EXPECT_EQ(contact.wrench_in_base.size(), 0);
}

TEST(ContactDetector, DetectsAnewAtTheResetWhereTheTouchLasts) {
  Detector detector;
  detector.see(blow);
  const ContactDetection& contact = detector.see_and_reset(touch);
  EXPECT_EQ(contact.level, ContactLevel::reaction);
  EXPECT_EQ(contact.detected, 1ms);
}

TEST(ContactDetector, DetectsNothingInAnEstimateThatIsNotThere) {
  const PlatformVector unusable[] = {PlatformVector::Constant(3, nan), PlatformVector{{nan, 100.0, 0.0}},
                                     PlatformVector{{0.0, std::numeric_limits<double>::infinity(), 0.0}},
                                     PlatformVector::Constant(2, 100.0), PlatformVector()};
  for (const PlatformVector& estimated : unusable) {
    const ContactDetection contact = Detector().see(estimated);
    EXPECT_FALSE(contact.valid);
    EXPECT_EQ(contact.level, ContactLevel::none);
    EXPECT_EQ(contact.present_level, ContactLevel::none);
  }
  const ContactDetection contact = Detector().see(blow, false);
  EXPECT_FALSE(contact.valid);
  EXPECT_EQ(contact.level, ContactLevel::none);
}

TEST(ContactDetector, KeepsADetectionWhileThereIsNoEstimate) {
  Detector detector;
  detector.see(touch);
  const ContactDetection& contact = detector.see(PlatformVector::Constant(3, nan), false);
  EXPECT_FALSE(contact.valid);
  EXPECT_EQ(contact.level, ContactLevel::reaction);
  EXPECT_EQ(contact.wrench_in_base, touch);
}

TEST(ContactDetector, DoesNotAllocate) {
  Detector detector;
  const test::AllocationCounter allocations;
  detector.see(quiet);
  detector.see(touch);
  detector.see_and_reset(blow);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(ContactDetector, AsksForPositiveThresholdsAndAHardOneNotBelowTheOther) {
  EXPECT_THROW(ContactDetector(rig(), {.reaction = {0.0, 1.0}, .hard = {60.0, 3.0}}), SetupError);
  EXPECT_THROW(ContactDetector(rig(), {.reaction = {10.0, nan}, .hard = {60.0, 3.0}}), SetupError);
  EXPECT_THROW(ContactDetector(rig(), {.reaction = {10.0, 1.0}, .hard = {60.0, 0.5}}), SetupError);
  EXPECT_NO_THROW(ContactDetector(rig(), {.reaction = {10.0, 1.0}, .hard = {10.0, 1.0}}));
}

}  // namespace
}  // namespace flinch
