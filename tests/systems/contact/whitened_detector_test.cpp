#include "systems/contact/whitened_detector.h"

#include <gtest/gtest.h>

#include <limits>

#include "systems/foundation/setup_error.h"
#include "tests/support/allocations.h"
#include "tests/support/answer_of_filters.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Deviations of 0.1 Nm, and of half of what friction or torque changes by; contacts are five of these.
WhitenedDetectorSettings settings() {
  const ResidualErrors errors{.noise = 0.1, .speed = 0.0, .load = 0.0, .torque = 0.5, .friction = 0.5};
  return {.level = {.threshold = 20.0, .errors = errors},
          .change = {.threshold = 5.0, .errors = errors},
          .tracking = {},
          .hard = {60.0, 3.0}};
}

/// The detector, fed with an estimate of the effort at the first drive.
class WhitenedDetectorTest : public testing::Test {
 protected:
  explicit WhitenedDetectorTest(const WhitenedDetectorSettings& by = settings())
      : block_(builder_.add<WhitenedDetector>("detector", test::planar_rig(), by)) {}

  const ContactDetection& see(double effort, Time late = 0ms) {
    const Time now = ticking_.now();
    load_.acquired = now;
    estimate_.acquired = now - late;
    estimate_.drive_torque = Eigen::Vector3d(effort, 0.0, 0.0);
    ticking_.set(load_port_, load_);
    ticking_.set(wrench_, estimate_);
    ticking_.set(reset_, reset_now_);
    ticking_.tick();
    return ticking_.get(block_.contact);
  }
  void settle(double effort = 0.0, Time late = 0ms) {
    for (int k = 0; k < 300; ++k) see(effort, late);
    ASSERT_EQ(see(effort, late).level, ContactLevel::none);
  }
  bool detects(double effort) { return see(effort).present_level != ContactLevel::none; }

  DiagramBuilder builder_;
  WhitenedDetector& block_;
  InputPort<WrenchEstimate> wrench_ = builder_.export_input("wrench", block_.wrench);
  InputPort<DriveLoad> load_port_ = builder_.export_input("load", block_.load);
  InputPort<ResetCommand> reset_ = builder_.export_input("reset", block_.reset);
  test::Ticking ticking_{builder_};
  DriveLoad load_{.acquired = {},
                  .valid = true,
                  .rate = Eigen::Vector3d::Zero(),
                  .torque = Eigen::Vector3d::Zero(),
                  .friction = Eigen::Vector3d::Zero(),
                  .friction_bounds = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()},
                  .inertia = Eigen::Vector3d::Zero(),
                  .turning = Eigen::Vector3d::Zero()};
  WrenchEstimate estimate_{
      .acquired = {}, .valid = true, .wrench_in_base = Eigen::Vector3d(5.0, 0.0, 0.0), .drive_torque = {}};
  ResetCommand reset_now_{};
};

TEST_F(WhitenedDetectorTest, NoticesAStepAboveTheThresholdOfItsChangeAlone) {
  settle();
  EXPECT_FALSE(detects(0.499));
  settle();
  EXPECT_TRUE(detects(0.501));
}

TEST_F(WhitenedDetectorTest, DoesNotNoticeWhatGrowsSlowly) {
  settle();
  for (double effort = 0.0; effort < 1.9; effort += 0.01) EXPECT_FALSE(detects(effort)) << effort;
}

TEST_F(WhitenedDetectorTest, NoticesWhatLastsByTheLevel) {
  settle();
  double effort = 0.0;
  while (!detects(effort) && effort < 3.0) effort += 0.01;
  EXPECT_NEAR(effort, 2.0, 0.011) << "20 deviations";
}

/// Judges by what is smoothed as well, whose noise is a tenth.
class Smoothing : public WhitenedDetectorTest {
 protected:
  Smoothing() : WhitenedDetectorTest(smoothing()) {}
  static WhitenedDetectorSettings smoothing() {
    WhitenedDetectorSettings by = settings();
    by.smoothed = MahalanobisThreshold{.threshold = 5.0, .errors = {.noise = 0.01, .rest = 0.2}};
    return by;
  }
  int ticks_to_notice(double effort) {
    for (int k = 1; k < 200; ++k)
      if (detects(effort)) return k;
    return 0;
  }
};

TEST_F(Smoothing, NoticesASmallForceThatLasts) {
  load_.rate = Eigen::Vector3d::Constant(1.0);
  settle();
  EXPECT_EQ(ticks_to_notice(0.049), 0);
  settle();
  // 0.05 Nm of 0.1 Nm: half of the way, after ln 2 / 400 1/s.
  EXPECT_EQ(ticks_to_notice(0.1), 2);
}

TEST_F(Smoothing, ExpectsOfADriveAtRestWhatItMayHoldByFriction) {
  settle();
  EXPECT_EQ(ticks_to_notice(0.4), 0) << "two deviations";
}

TEST_F(Smoothing, WaitsUntilItHasSettled) {
  load_.rate = Eigen::Vector3d::Constant(1.0);
  const auto settling = static_cast<int>(WhitenedDetectorSettings{}.tracking.smoothing_time() / 1ms);
  for (int k = 0; k < settling; ++k) ASSERT_FALSE(detects(0.1)) << k;
  EXPECT_TRUE(detects(0.1) || detects(0.1));
}

TEST_F(WhitenedDetectorTest, ExpectsLargerErrorsWhereFrictionOrTorqueHaveJustChanged) {
  settle();
  load_.friction[0] = 1.2;
  EXPECT_FALSE(detects(2.4)) << "five deviations of hypot(0.1, 0.5 1.2)";
  settle();
  load_.torque[0] = 4.0;
  EXPECT_FALSE(detects(2.4 + 0.5));
  settle();
  EXPECT_TRUE(detects(2.4 + 1.2)) << "nothing has changed";
}

/// Judges an estimator that answers through three filters.
class BehindFilters : public WhitenedDetectorTest {
 protected:
  BehindFilters() : WhitenedDetectorTest(answering()) {}
  static WhitenedDetectorSettings answering() {
    WhitenedDetectorSettings slow = settings();
    slow.tracking.answer = {.filters = 3, .rate = 300.0};
    return slow;
  }
};

TEST_F(BehindFilters, AnErrorIsExpectedWhenTheEstimatorShowsIt) {
  settle();
  load_.friction[0] = 1.2;
  for (int k = 1; k < 60; ++k) EXPECT_FALSE(detects(2.4 * test::answer_of_three_filters(0.3 * k))) << k;
}

TEST_F(BehindFilters, AnErrorIsNotExpectedBefore) {
  settle();
  load_.friction[0] = 1.2;
  EXPECT_TRUE(detects(0.6)) << "what friction does is not seen yet";
}

/// Judges what changes by the likelihood ratio of onsets, of errors that are independent.
class ByOnsets : public WhitenedDetectorTest {
 protected:
  ByOnsets() : WhitenedDetectorTest(by_onsets()) {}
  static WhitenedDetectorSettings by_onsets() {
    WhitenedDetectorSettings onsets = settings();
    onsets.onset = {.threshold = 5.0, .course = {}};
    return onsets;
  }
};

// Of a step of 3 deviations n samples have a distance of 3 sqrt(sum of g^2), where g falls by a twentieth a
// sample: 3, 4.1, 4.9, 5.6.
TEST_F(ByOnsets, NoticesAStepThatIsTooSmallAtOnceAsSoonAsItsSamplesAddUp) {
  settle();
  for (int n = 1; n <= 4; ++n) EXPECT_EQ(detects(0.3), n == 4) << n;
}

// An onset is told from the four samples before it, so nothing is detected until the fifth after the gap.
TEST_F(ByOnsets, BeginsAnewAfterASingleInvalidSample) {
  settle();
  estimate_.valid = false;
  EXPECT_FALSE(see(0.0).valid);
  estimate_.valid = true;
  for (std::size_t k = 0; k < AutoregressiveError::order; ++k) EXPECT_FALSE(detects(1.0)) << k;
  EXPECT_TRUE(detects(1.6));
}

TEST_F(ByOnsets, NoticesAStepAboveTheThresholdAtOnce) {
  settle();
  EXPECT_FALSE(detects(0.499));
  settle();
  EXPECT_TRUE(detects(0.501));
}

TEST_F(ByOnsets, NoticesNothingInSilenceNorInWhatGrowsSlowly) {
  settle();
  for (double effort = 0.0; effort < 1.0; effort += 0.001) EXPECT_FALSE(detects(effort)) << effort;
}

TEST_F(ByOnsets, NoticesWhatLastsByTheLevel) {
  settle();
  double effort = 0.0;
  while (!detects(effort) && effort < 3.0) effort += 0.001;
  EXPECT_NEAR(effort, 2.0, 0.0011) << "20 deviations";
}

TEST_F(ByOnsets, BeginsAnewAfterAGapAndWaitsForItsMean) {
  settle();
  estimate_.valid = false;
  for (int k = 0; k < 10; ++k) EXPECT_FALSE(see(0.0).valid);
  estimate_.valid = true;
  for (int k = 0; k < 60; ++k) EXPECT_FALSE(detects(1.0));
  settle(1.0);
  EXPECT_TRUE(detects(1.6));
}

TEST_F(ByOnsets, NoticesNothingInATickWithoutANewEstimateNorOfAnotherEstimator) {
  settle();
  ASSERT_TRUE(detects(1.0));
  const Time late = ticking_.now() - estimate_.acquired;
  EXPECT_EQ(see(1.0, late).present_level, ContactLevel::none);
  estimate_.health.fallen_back = true;
  EXPECT_FALSE(see(100.0).valid);
  EXPECT_EQ(see(100.0).present_level, ContactLevel::none);
}

TEST_F(ByOnsets, IsNotLedAstrayByWhatIsNotFinite) {
  settle();
  EXPECT_EQ(see(nan).level, ContactLevel::none);
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(detects(0.0));
  EXPECT_TRUE(detects(1.0));
}

TEST_F(ByOnsets, NeverAllocates) {
  settle();
  const test::AllocationCounter counter;
  for (int k = 0; k < 100; ++k) see(k % 7 == 0 ? 1.0 : 0.0, 3ms);
  EXPECT_EQ(counter.count(), 0);
}

TEST_F(WhitenedDetectorTest, SetsALateEstimateBesideTheLoadOfItsTime) {
  settle(0.0, 4ms);
  load_.friction[0] = 1.2;
  for (int k = 0; k < 4; ++k) EXPECT_EQ(see(0.0, 4ms).level, ContactLevel::none);
  EXPECT_EQ(see(2.4, 4ms).level, ContactLevel::none) << "the friction changed four ticks ago";
  settle(0.0, 4ms);
  load_.friction[0] = 0.0;
  EXPECT_NE(see(2.4, 4ms).level, ContactLevel::none) << "it changed now, and the estimate tells of before";
}

TEST_F(WhitenedDetectorTest, LatchesUntilTheReset) {
  settle();
  const ContactDetection detected = see(1.0);
  EXPECT_EQ(detected.level, ContactLevel::reaction);
  EXPECT_EQ(detected.wrench_in_base, estimate_.wrench_in_base);
  for (int k = 0; k < 300; ++k) see(0.0);
  EXPECT_EQ(see(0.0).level, ContactLevel::reaction);
  EXPECT_EQ(see(0.0).detected, detected.detected);
  reset_now_.reset = true;
  EXPECT_EQ(see(0.0).level, ContactLevel::none);
}

TEST_F(WhitenedDetectorTest, CallsHardWhatIsDetectedAndAboveTheHardThreshold) {
  settle();
  estimate_.wrench_in_base[1] = -61.0;
  EXPECT_EQ(see(0.0).level, ContactLevel::none) << "a large wrench that is expected is no contact";
  EXPECT_EQ(see(1.0).level, ContactLevel::hard);
}

TEST_F(WhitenedDetectorTest, DoesNotJudgeAnEstimateOfAnotherEstimator) {
  settle();
  estimate_.health.fallen_back = true;
  const ContactDetection& told = see(100.0);
  EXPECT_FALSE(told.valid);
  EXPECT_EQ(told.level, ContactLevel::none);
}

TEST_F(WhitenedDetectorTest, BeginsAnewAfterAGapAndWaitsForItsMean) {
  settle();
  estimate_.valid = false;
  for (int k = 0; k < 10; ++k) EXPECT_FALSE(see(0.0).valid);
  estimate_.valid = true;
  EXPECT_FALSE(detects(1.0)) << "there is no mean of late to compare with";
  for (int k = 0; k < 59; ++k) EXPECT_FALSE(detects(1.0));
  settle(1.0);
  EXPECT_TRUE(detects(1.6));
}

TEST_F(WhitenedDetectorTest, NoticesNothingInATickWithoutANewEstimate) {
  settle();
  ASSERT_TRUE(detects(1.0));
  const Time acquired = estimate_.acquired;
  const Time late = ticking_.now() - acquired;
  EXPECT_EQ(see(1.0, late).present_level, ContactLevel::none);
  EXPECT_TRUE(see(1.0, late + 1ms).valid) << "it is held";
}

TEST_F(WhitenedDetectorTest, IsNotLedAstrayByWhatIsNotFinite) {
  settle();
  EXPECT_EQ(see(nan).level, ContactLevel::none);
  load_.valid = false;
  EXPECT_EQ(see(0.0).level, ContactLevel::none);
  load_.valid = true;
  for (int k = 0; k < 100; ++k) see(0.0);
  EXPECT_TRUE(detects(1.0));
}

TEST_F(WhitenedDetectorTest, NeverAllocates) {
  settle();
  const test::AllocationCounter counter;
  for (int k = 0; k < 100; ++k) see(k % 7 == 0 ? 1.0 : 0.0, 3ms);
  EXPECT_EQ(counter.count(), 0);
}

TEST(WhitenedDetectorSettings, AreRefusedWhereFiltersHaveNoRateOrAreTooMany) {
  WhitenedDetectorSettings wrong = settings();
  wrong.tracking.answer = {.filters = 4, .rate = 0.0};
  try {
    const WhitenedDetector detector(test::planar_rig(), wrong);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 2U);
  }
}

TEST(WhitenedDetectorSettings, AreRefusedWhereAThresholdOrTheNoiseIsMissing) {
  try {
    const WhitenedDetector detector(test::planar_rig(), {});
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 4U);
  }
}

TEST(WhitenedDetectorSettings, AreRefusedWhereAnOnsetIsNotCalibrated) {
  WhitenedDetectorSettings wrong = settings();
  wrong.onset = {.threshold = 0.0, .course = {.prediction = {nan, 0.0, 0.0, 0.0}, .innovation = 0.0}};
  try {
    const WhitenedDetector detector(test::planar_rig(), wrong);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 3U);
  }
}

}  // namespace
}  // namespace flinch
