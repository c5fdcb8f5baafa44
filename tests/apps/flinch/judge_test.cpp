// flinch judge: its table, its page, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/comparison/judged_page.h"
#include "tests/apps/flinch/program.h"
#include "tests/experiments/report/chromium.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using nlohmann::json;
using test::flinch;
using test::Outcome;
using ::testing::HasSubstr;

class JudgeVerb : public ::testing::Test {
 protected:
  JudgeVerb() {
    const Outcome run = flinch(
        {"run", place.at("scenarios/platform_collision_fused.yaml"), "--out", place.at("run"), "--json"});
    onset = json::parse(run.out).at("contacts")[0].at("onset_s");
  }

  /// What the page of a call holds.
  json page(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"judge", place.at("run/run.h5"), "-o", place.at("judged.html")});
    const Outcome outcome = flinch(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const std::string html = test::bytes_of(place / "judged.html");
    const std::string begin = "id=\"data\">";
    const std::size_t from = html.find(begin) + begin.size();
    return json::parse(html.substr(from, html.find("</script>", from) - from));
  }

  test::Workplace place;
  double onset = 0.0;
};

TEST_F(JudgeVerb, ShowsOnAPageWhatItsTableTells) {
  const std::vector<std::string> truth = {"--free", "0.1..0.4", "--contact", std::to_string(onset)};
  const json shown = page(truth);
  std::vector<std::string> arguments = {"judge", place.at("run/run.h5"), "--json"};
  arguments.insert(arguments.end(), truth.begin(), truth.end());
  const json told = json::parse(flinch(arguments).out);
  ASSERT_FALSE(shown.at("detectors").empty());
  for (const json& row : shown["detectors"]) {
    const std::string by = row.at("by");
    EXPECT_EQ(row.at("false_alarms"), told.at("false_alarms").at(by));
    EXPECT_EQ(row.at("at_most"), told.at("false_alarms_at_most_per_h").at(by));
    if (row.at("delays")[0].is_null()) continue;
    EXPECT_NEAR(1e3 * row["delays"][0].get<double>(), told.at("detection_ms").at(by).get<double>(), 1e-9);
  }
  EXPECT_EQ(shown.at("lanes").size(), shown["detectors"].size() + 1);
  EXPECT_EQ(
      shown["lanes"][0].at("changes"),
      json({{0, 0}, {100, 1}, {400, 0}, {std::ceil(1e3 * onset), 2}, {std::ceil(1e3 * onset) + 100, 0}}));
  expect_works_in_chromium(place / "judged.html", "comparison/judged_in_browser.py");
}

TEST_F(JudgeVerb, DrawsTheEstimatesThatARunOfTheSameControlHasRecorded) {
  const Recording recorded = read_recording(place / "run/run.h5");
  const ChartAxis axis = chart_axis(1e-9 * static_cast<double>(recorded.time_ns.front()),
                                    1e-9 * static_cast<double>(recorded.time_ns.back()), 1e-3);
  SignalDrawing drawing("wrench", axis);
  drawing.see(recorded);
  std::size_t compared = 0;
  const json shown = page({});
  for (const json& chart : shown.at("charts")) {
    for (const DrawnComponent& component : drawing.components()) {
      if (chart.at("id") != "wrench_wrench_in_base_" + component.name) continue;
      for (const json& series : chart.at("series")) {
        if (series.at("run") != 1) continue;
        EXPECT_EQ(series.at("values"), json(short_numbers(component.values))) << component.name;
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 3U);
}

TEST_F(JudgeVerb, TakesContactsFromTheForceSensorOfTheLog) {
  const json shown = page({"--truth", "force"});
  const json told = json::parse(flinch({"judge", place.at("run/run.h5"), "--truth", "force", "--json"}).out);
  ASSERT_FALSE(told.at("measured_contacts").empty());
  const double begin = told["measured_contacts"][0].at("from_s");
  EXPECT_NEAR(begin, onset, 1e-3 + 1e-9);
  EXPECT_EQ(shown.at("truth"), "measured by the force sensor");
  EXPECT_EQ(shown.at("contacts")[0].at("start"), begin);
  EXPECT_EQ(shown["contacts"][0].at("removed"), told["measured_contacts"][0].at("to_s"));
  EXPECT_EQ(shown["lanes"][0].at("name"), "measured by the force sensor");
  EXPECT_GT(told.at("free_seconds").get<double>(), 0.0);
}

TEST_F(JudgeVerb, RefusesTruthOfTwoKinds) {
  const Outcome both = flinch({"judge", place.at("run/run.h5"), "--truth", "force", "--contact", "1"});
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err, HasSubstr("--contact: with --truth force the sensor says when contacts begin"));
  const Outcome alone = flinch({"judge", place.at("run/run.h5"), "--contact-force", "3"});
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(alone.err, HasSubstr("--contact-force: is of --truth force, which is not given"));
}

TEST_F(JudgeVerb, RefusesAPageThatIsNone) {
  const Outcome outcome = flinch({"judge", place.at("run/run.h5"), "-o", place.at("judged.csv")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("judged.csv: is no name of a page of flinch"));
}

}  // namespace
}  // namespace flinch
