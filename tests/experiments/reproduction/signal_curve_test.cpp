#include "experiments/reproduction/signal_curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "systems/framework/diagram_builder.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "tests/systems/framework/random_source.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using Kind = CurveStatistic::Kind;

CurveSamples curve_of(std::vector<double> values) {
  CurveSamples curve;
  for (std::size_t k = 0; k < values.size(); ++k) curve.time.push_back(0.1 * static_cast<double>(k));
  curve.value = std::move(values);
  return curve;
}

std::optional<double> take(Kind kind, const CurveSamples& curve, double level = 0.0,
                           const CurveSamples& other = {}) {
  CurveStatistic statistic;
  statistic.kind = kind;
  statistic.level = level;
  return taken(statistic, curve, other);
}

TEST(SignalNumber, IsASignalAFieldAndAnElement) {
  EXPECT_EQ(signal_number("motion.pose[2]"), (SignalNumber{"motion", "pose", 2}));
  EXPECT_EQ(signal_number("contact.strongest.force_in_base[1]"),
            (SignalNumber{"contact", "strongest.force_in_base", 1}));
  EXPECT_EQ(signal_number("measures.sigma_sc"), (SignalNumber{"measures", "sigma_sc", 0}));
  for (const char* const wrong : {"", "motion", "motion.", ".pose", "motion.pose[", "motion.pose[]",
                                  "motion.pose[x]", "motion.pose[1", "motion.pose[-1]", "motion.pose[1]x"})
    EXPECT_FALSE(signal_number(wrong)) << wrong;
}

TEST(CurveStatistic, IsThatOfItsSamples) {
  const CurveSamples curve = curve_of({1.0, -2.0, 3.0, -4.0});
  EXPECT_EQ(take(Kind::largest, curve), 3.0);
  EXPECT_EQ(take(Kind::least, curve), -4.0);
  EXPECT_EQ(take(Kind::last, curve), -4.0);
  EXPECT_EQ(take(Kind::mean, curve), -0.5);
  EXPECT_DOUBLE_EQ(*take(Kind::rms, curve), std::sqrt(30.0 / 4.0));
  EXPECT_FALSE(take(Kind::largest, {}));
}

TEST(LongestStretch, IsFromItsFirstToItsLastSample) {
  const CurveSamples curve = curve_of({0.0, 5.0, 0.0, 0.0, 0.0, 5.0, 5.0});
  EXPECT_DOUBLE_EQ(*take(Kind::longest_below, curve, 1.0), 0.2);
  EXPECT_NEAR(*take(Kind::longest_above, curve, 1.0), 0.1, 1e-12);
  EXPECT_EQ(take(Kind::longest_above, curve, 9.0), 0.0);
}

TEST(Slope, IsThatOfTheLineThroughPairsOfOneTime) {
  CurveSamples x = curve_of({0.0, 1.0, 2.0, 3.0});
  const CurveSamples y = curve_of({5.0, 8.0, 11.0, 14.0});
  EXPECT_DOUBLE_EQ(*take(Kind::slope, y, 0.0, x), 3.0);
  x.time.erase(x.time.begin() + 1);
  x.value.erase(x.value.begin() + 1);
  EXPECT_DOUBLE_EQ(*take(Kind::slope, y, 0.0, x), 3.0) << "a sample that only one has does not count";
  EXPECT_FALSE(take(Kind::slope, y, 0.0, curve_of({1.0, 1.0, 1.0, 1.0}))) << "a line that stands upright";
  EXPECT_FALSE(take(Kind::slope, curve_of({1.0, 2.0}), 0.0, curve_of({1.0, 2.0})));
}

TEST(ErrorsInSharesOfARange, AndSignalToNoiseAreThoseOfAConstantError) {
  const CurveSamples signal = curve_of({-10.0, 0.0, 10.0, 0.0});
  const CurveSamples error = curve_of({1.0, 1.0, -1.0, -1.0});
  EXPECT_DOUBLE_EQ(*take(Kind::share_of_range, error, 0.0, signal), 0.05);
  EXPECT_DOUBLE_EQ(*take(Kind::signal_to_noise, error, 0.0, signal), 10.0 * std::log10(200.0 / 4.0));
}

/// A source of random samples, recorded at 1 ms.
Recording random_samples() {
  DiagramBuilder builder("random");
  builder.add<test::Source>("source");
  const auto diagram = builder.build();
  Recorder recorder(*diagram, {"source/sample"}, 100);
  Simulator simulator(*diagram);
  simulator.record(recorder);
  Context context = diagram->make_context();
  simulator.advance_to(context, std::chrono::milliseconds(100));
  return recorder.recording({});
}

SignalNumber number_of(const std::string& field) { return {"source/sample", field}; }

class Curve : public testing::Test {
 protected:
  const Recording recording = random_samples();
  const std::vector<double> x = recording.column("source/sample", "pair.0");
  const std::vector<double> y = recording.column("source/sample", "pair.1");
  SignalCurve curve;

  Curve() { curve.terms = {{number_of("pair.0"), std::nullopt}}; }
};

TEST_F(Curve, IsTheRecordedNumberTimesItsFactor) {
  curve.times = 1000.0;
  const CurveSamples samples = *sampled(curve, recording, {});
  ASSERT_EQ(samples.value.size(), x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    EXPECT_EQ(samples.value[k], 1000.0 * x[k]);
    EXPECT_NEAR(samples.time[k], 1e-3 * static_cast<double>(k), 1e-12);
  }
}

TEST_F(Curve, IsTheLengthOfItsTermsAndTakesOffWhatWasRecordedBefore) {
  curve.terms = {{number_of("pair.0"), number_of("pair.1")}, {number_of("pair.1"), std::nullopt}};
  curve.is_length = true;
  curve.less_earlier = 3e-3;
  const CurveSamples samples = *sampled(curve, recording, {});
  ASSERT_EQ(samples.value.size(), x.size() - 3) << "the first three have nothing before them";
  for (std::size_t k = 3; k < x.size(); ++k)
    EXPECT_DOUBLE_EQ(samples.value[k - 3], std::hypot(x[k] - y[k - 3], y[k]));
}

TEST_F(Curve, CountsTimesFromTheContactAndOnlyWhereItsFlagIs) {
  curve.since_contact = true;
  curve.from = 0.0;
  curve.to = 20e-3;
  curve.where = number_of("good");
  const CurveSamples samples = *sampled(curve, recording, 50e-3);
  const std::vector<double> good = recording.column("source/sample", "good");
  std::vector<double> expected;
  for (std::size_t k = 50; k <= 70; ++k)
    if (good[k] != 0.0) expected.push_back(x[k]);
  EXPECT_EQ(samples.value, expected);
  EXPECT_LT(expected.size(), 21U) << "or the flag was never away";
  EXPECT_FALSE(sampled(curve, recording, {})) << "without a contact";
}

TEST_F(Curve, NamesItsSignals) {
  curve.terms = {{{"a", "x"}, SignalNumber{"b", "x"}}};
  curve.where = {"c", "valid"};
  EXPECT_THAT(curve.signals(), ElementsAre("a", "b", "c"));
}

TEST(Words, NameEachStatistic) {
  EXPECT_STREQ(word(Kind::largest), "largest");
  EXPECT_STREQ(word(Kind::signal_to_noise), "signal_to_noise");
}

}  // namespace
}  // namespace flinch
