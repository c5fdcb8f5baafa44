#include "experiments/comparison/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/comparison/comparison_page.h"
#include "experiments/comparison/signal_drawing.h"
#include "systems/foundation/setup_error.h"
#include "systems/signals/platform_motion.h"
#include "tests/experiments/report/chromium.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using SixVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

struct Angles {
  SixVector active;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("active", "rad", self.active);
  }
};

struct Level {
  std::int64_t level = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("level", "", self.level);
  }
};

template <class Value>
void append(const Value& value, Signal& signal) {
  std::vector<internal::Number> row(signal.layout.numbers);
  write_row(value, row.data());
  signal.rows.insert(signal.rows.end(), row.begin(), row.end());
}

/// A move of two drives that begins at `begin` and repeats nowhere, seen from `start` on.
Recording some_motion(Time period, std::size_t samples, double start, double begin) {
  Recording recording;
  recording.period = period;
  recording.signals = {{"joints", row_layout<Angles>(), {}}, {"detection", row_layout<Level>(), {}}};
  for (std::size_t k = 0; k < samples; ++k) {
    const double time = start + to_seconds(period) * static_cast<double>(k);
    recording.time_ns.push_back(std::llround(1e9 * time));
    const double moved = std::max(0.0, time - begin);
    append(Angles{SixVector::Constant(2, std::sin(3.0 * moved * moved))
                      .cwiseProduct(SixVector::LinSpaced(2, 1.0, -0.4))},
           recording.signals[0]);
    append(Level{time > begin + 1.0 ? 1 : 0}, recording.signals[1]);
  }
  return recording;
}

class TwoRecordings : public ::testing::Test {
 protected:
  /// Changes the last bit of a number.
  static void spoil(Recording& recording, std::size_t signal, std::size_t sample, std::size_t number) {
    Signal& spoilt = recording.signals[signal];
    spoilt.rows[sample * spoilt.layout.numbers + number].integer ^= 1;
  }

  Recording one = some_motion(1ms, 9000, 0.0, 0.5);
  Recording other = one;
};

TEST_F(TwoRecordings, AreTheSameBitForBit) { EXPECT_FALSE(first_difference(one, other)); }

TEST_F(TwoRecordings, PartAtTheFirstTickOfAnySignal) {
  spoil(other, 0, 8000, 2);
  spoil(other, 1, 5003, 0);
  spoil(other, 0, 5004, 3);
  const auto found = first_difference(one, other);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->tick, 5003U);
  EXPECT_EQ(found->signal, "detection");
  EXPECT_NEAR(found->time, 5.003, 1e-12);
  EXPECT_TRUE(found->others.empty());
}

TEST_F(TwoRecordings, PartInSeveralSignalsAtOnce) {
  spoil(other, 0, 17, 3);
  spoil(other, 1, 17, 0);
  spoil(other, 1, 20, 0);
  const auto found = first_difference(one, other);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->tick, 17U);
  EXPECT_EQ(found->signal, "joints");
  EXPECT_THAT(found->others, ElementsAre("detection"));
}

TEST_F(TwoRecordings, PartWhereOneEndsOrHasAnotherTime) {
  other.time_ns[7000] += 1;
  EXPECT_EQ(first_difference(one, other)->tick, 7000U);
  EXPECT_EQ(first_difference(one, other)->signal, "time_ns");
  const Recording shorter = some_motion(1ms, 6000, 0.0, 0.5);
  EXPECT_EQ(first_difference(one, shorter)->tick, 6000U);
  EXPECT_EQ(first_difference(shorter, one)->tick, 6000U);
}

TEST_F(TwoRecordings, TellSignalsThatOnlyOneHas) {
  other.signals[1].path = "detection_by_other";
  EXPECT_THAT(signals_of_one(one, other), ElementsAre("detection", "detection_by_other"));
  other.signals[0].layout.fields[0].capacity = 5;
  EXPECT_THAT(signals_of_one(one, other), ElementsAre("joints", "detection", "detection_by_other"));
}

TEST_F(TwoRecordings, AreLaidOnEachOtherByTheirMotion) {
  EXPECT_NEAR(delay_by_correlation(one, some_motion(1ms, 9000, 0.0, 1.317)), 0.817, 1.1e-3);
  EXPECT_NEAR(delay_by_correlation(one, some_motion(1ms, 7000, 0.2, 0.1)), -0.4, 1.1e-3);
  EXPECT_NEAR(delay_by_correlation(one, some_motion(4ms, 2000, 0.0, 0.95)), 0.45, 4.1e-3) << "another rate";
  EXPECT_NEAR(delay_by_correlation(one, one), 0.0, 1e-12);
}

TEST_F(TwoRecordings, CannotBeCorrelatedWithoutAMotion) {
  const Recording still = some_motion(1ms, 9000, 0.0, 100.0);
  EXPECT_THAT(test::problems_of([&] { delay_by_correlation(one, still); }),
              ElementsAre(HasSubstr("a motion to correlate is not in both")));
  other.signals.erase(other.signals.begin());
  EXPECT_THAT(test::problems_of([&] { delay_by_correlation(one, other); }),
              ElementsAre(HasSubstr("there are no angles of drives")));
}

TEST(DifferingSettings, AreThoseThatAreNotTheSameInAll) {
  const std::vector<ReadValue> a = {
      {"gain", "20", "1/s", true}, {"mass", "2", "kg", true}, {"old", "1", "", true}};
  const std::vector<ReadValue> b = {{"gain", "30", "1/s", true}, {"mass", "2", "kg", false}};
  const auto settings = differing_settings({a, b});
  ASSERT_EQ(settings.size(), 2U);
  EXPECT_EQ(settings[0].key, "gain");
  EXPECT_THAT(settings[0].values, ElementsAre("20", "30"));
  EXPECT_THAT(settings[1].values, ElementsAre("1", std::nullopt));
}

json data_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t first = page.find(begin) + begin.size();
  return json::parse(page.substr(first, page.find("</script>", first) - first));
}

TEST_F(TwoRecordings, ShareAPageWithOneTimeAxis) {
  const Recording late = some_motion(1ms, 9000, 0.0, 1.3);
  const std::string page = comparison_page(
      {{"a.h5", &one, 0.0, {{"verdict", "good"}}, true}, {"b.h5", &late, 0.8, {{"verdict", "bad"}}, false}},
      {"correlation", "They part.", {{"gain", "1/s", {"20", std::nullopt}}}, "flinch compare"});
  EXPECT_EQ(page.find("{{ "), std::string::npos);
  const json data = data_of(page);
  EXPECT_EQ(data["count"], 4000);
  EXPECT_NEAR(data["start"], -0.8, 1e-9);
  ASSERT_EQ(data["charts"].size(), 3U);  // a level and two drives
  // Once the second is drawn earlier by its delay, both are one curve, where both are there.
  for (const json& chart : data["charts"]) {
    ASSERT_EQ(chart["series"].size(), 2U);
    std::size_t compared = 0;
    for (std::size_t k = 900; k < 3300; ++k) {
      const json& a = chart["series"][0]["values"][k];
      const json& b = chart["series"][1]["values"][k];
      if (a.is_null() || b.is_null()) continue;
      ++compared;
      ASSERT_NEAR(a.get<double>(), b.get<double>(), 0.08) << chart["id"] << " " << k;
    }
    EXPECT_GT(compared, 2300U);
  }
  const test::TemporaryFolder folder;
  expect_works_in_chromium(folder.write("page.html", page), "comparison/comparison_in_browser.py");
}

TEST_F(TwoRecordings, AreDrawnWithTheirPeaks) {
  other.signals[1].rows[4321 * other.signals[1].layout.numbers].integer = 7;
  const json data =
      data_of(comparison_page({{"a", &one, 0.0, {}, false}, {"b", &other, 0.0, {}, false}}, {}));
  for (const json& chart : data["charts"]) {
    if (chart["id"] != "detection_level") continue;
    const auto& values = chart["series"][1]["values"];
    EXPECT_EQ(std::count(values.begin(), values.end(), json(7.0)), 1);
  }
}

TEST(SignalDrawing, LeavesAGapWhereAPoseIsNotKnown) {
  using Status = PlatformMotion::Status;
  const std::vector<Status> statuses = {Status::valid,       Status::no_data,  Status::not_converged,
                                        Status::implausible, Status::singular, Status::valid};
  Recording recording;
  recording.period = 1ms;
  recording.signals = {{"motion", row_layout<PlatformMotion>(), {}}};
  for (std::size_t k = 0; k < statuses.size(); ++k) {
    recording.time_ns.push_back(static_cast<std::int64_t>(k) * 1'000'000);
    PlatformMotion motion;
    motion.status = statuses[k];
    motion.pose = Configuration::Constant(3, 0.25);
    motion.velocity = PlatformVector::Constant(3, 0.5);
    append(motion, recording.signals[0]);
  }
  SignalDrawing drawing("motion", chart_axis(0.0, 0.005, 0.001));
  drawing.see(recording);
  ASSERT_EQ(drawing.components().size(), 6U);
  for (const DrawnComponent& component : drawing.components()) {
    const bool is_pose = component.field == "pose";
    for (std::size_t k = 0; k < statuses.size(); ++k) {
      if (statuses[k] == Status::valid || (is_pose && statuses[k] == Status::singular)) {
        EXPECT_EQ(component.values[k], is_pose ? 0.25 : 0.5) << component.name << k;
      } else {
        EXPECT_TRUE(std::isnan(component.values[k])) << component.name << k;
      }
    }
  }
}

}  // namespace
}  // namespace flinch
