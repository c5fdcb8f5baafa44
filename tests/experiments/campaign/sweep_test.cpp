#include "experiments/campaign/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/run_campaign.h"
#include "experiments/simulated/experiment.h"
#include "experiments/verdict/verdict.h"
#include "experiments/verdict/verdict_output.h"
#include "systems/framework/recording.h"
#include "systems/robot/parallel_robot.h"
#include "tests/experiments/report/chromium.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string gain = "control.momentum_observer.gain";

class ASweep : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* folder : {"whole", "other"}) std::filesystem::create_directories(place / folder);
    place.replace("scenarios/platform_collision.yaml", "duration_s: 1.2", "duration_s: 0.6");
  }

  std::vector<std::string> problems_of(const std::vector<std::string>& set,
                                       std::optional<std::uint64_t> seed = std::nullopt) const {
    return test::problems_of([&] { read_sweep(scenario, set, seed); });
  }
  CampaignResults run(const Campaign& sweep) const { return run_campaign(sweep, place / "whole", 2); }

  test::Workplace place;
  std::filesystem::path scenario = place / "scenarios/platform_collision.yaml";
};

/// The figures of one run, made as 'flinch run' makes it.
json figures_of_single_run(const std::filesystem::path& scenario, const std::vector<std::string>& set) {
  const SimulatedScenario alone = read_simulated_scenario(scenario, set);
  const Recording recording = run_experiment(alone);
  const Verdict verdict = judge(recording, alone.robot.robot->space(), alone.expected, alone.force_limits);
  json figures = json::parse(verdict_json(verdict, {.seed = alone.seed}));
  figures.erase("wall_s");
  return figures;
}

TEST_F(ASweep, ShowsTheFiguresOfEachRunAsIfItWereAlone) {
  const Campaign sweep = read_sweep(scenario, {gain + "=20,150", "pylon.radius_mm=35"});
  json rows = json::parse(sweep_json(sweep, run(sweep)))["rows"];
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0]["value"], 20);
  EXPECT_EQ(rows[1]["value"], 150);
  for (json& row : rows) {
    const std::string value = row["value"].dump();
    row.erase("value");
    EXPECT_EQ(row, figures_of_single_run(scenario, {gain + "=" + value, "pylon.radius_mm=35"}));
  }
  EXPECT_NE(rows[0]["contacts"][0]["detection_ms"], rows[1]["contacts"][0]["detection_ms"]);
}

TEST_F(ASweep, MakesAGridOfTwoKeysAndNamesItsPointsAsTheyWereTyped) {
  const Campaign sweep = read_sweep(scenario, {gain + "=20,40", "motion.speed_m_per_s=0.5..0.7:0.1"});
  ASSERT_EQ(sweep.runs(), 6U);
  EXPECT_EQ(draw_run(sweep, 0).values, (std::vector<std::pair<std::string, std::string>>{
                                           {gain + "_per_s", "20"}, {"motion.speed_m_per_s", "0.5"}}));
  EXPECT_EQ(draw_run(sweep, 5).values, (std::vector<std::pair<std::string, std::string>>{
                                           {gain + "_per_s", "40"}, {"motion.speed_m_per_s", "0.7"}}));
}

TEST_F(ASweep, GivesEachRunTheSeedOfTheScenarioOrWhatItIsTold) {
  EXPECT_EQ(draw_run(read_sweep(scenario, {gain + "=20,40"}), 1).scenario.seed,
            read_simulated_scenario(scenario).seed);
  EXPECT_EQ(draw_run(read_sweep(scenario, {gain + "=20,40"}, 7), 1).scenario.seed, 7U);
  EXPECT_EQ(draw_run(read_sweep(scenario, {"seed=3..5:1"}), 2).scenario.seed, 5U);
}

TEST_F(ASweep, GoesOnWhereItWasStoppedForAnyNumberOfThreads) {
  const Campaign sweep = read_sweep(scenario, {gain + "=20..80:20"});
  const std::string whole = sweep_json(sweep, run(sweep));
  run_campaign(sweep, place / "other", 1, [](std::size_t done, std::size_t) { return done == 0; });
  EXPECT_EQ(sweep_json(sweep, run_campaign(sweep, place / "other", 3)), whole);
  EXPECT_EQ(test::bytes_of(place / "whole/results.csv").find("\"\"contacts"), std::string::npos)
      << "a table is for numbers";
}

TEST_F(ASweep, SaysAllThatIsWrong) {
  EXPECT_THAT(problems_of({gain + "=20,40", "pylon", "robot.x=3"}),
              ElementsAre("--set pylon: is not of the form KEY=VALUE", HasSubstr("--set robot.x=3: ")));
  EXPECT_THAT(problems_of({gain + "=20,40", gain + "_per_s=1,2"}),
              ElementsAre(HasSubstr("is given several values twice")));
  EXPECT_THAT(problems_of({"seed=1,2"}, 4), ElementsAre(HasSubstr("--seed: 'seed' is varied")));
  EXPECT_THAT(problems_of({gain + "=1..5000:1", "duration_s=1..5000:1"}),
              ElementsAre(HasSubstr("--set: asks for 25000000 runs")));
  const Campaign wrong = read_sweep(scenario, {"pylon.radios_mm=1,2"});
  EXPECT_THAT(test::problems_of([&] { check_campaign(wrong); }),
              ElementsAre(HasSubstr("pylon.radios_mm: is not a known key; did you mean 'radius_m'?")));
}

TEST_F(ASweep, TellsARowAValueAndShowsACurveOfEveryFigure) {
  const Campaign sweep = read_sweep(scenario, {gain + "=20..100:40", "pylon.radius_mm=30,40"});
  const CampaignResults results = run(sweep);
  const std::string table = sweep_table(sweep, results);
  EXPECT_THAT(table, HasSubstr(": 6 runs over control.momentum_observer.gain_per_s, pylon.radius_mm\n"));
  EXPECT_THAT(table, HasSubstr(" 60, 40  good "));
  const std::string page = sweep_page(
      sweep, results, [](const auto& values) { return "flinch run " + values.front().second; }, "call");
  EXPECT_EQ(page.find("{{ "), std::string::npos);
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t first = page.find(begin) + begin.size();
  const json data = json::parse(page.substr(first, page.find("</script>", first) - first));
  EXPECT_EQ(data["rows"][1]["call"], "flinch run 60");
  EXPECT_EQ(data["rows"][1]["values"], json::parse("[60, 30]")) << "as they were typed";
  std::vector<std::string> names;
  for (const json& curve : data["curves"]) {
    names.push_back(curve["name"]);
    EXPECT_EQ(curve["values"].size(), 6U);
  }
  EXPECT_THAT(names, ::testing::IsSupersetOf(
                         {"first contact: detection", "first contact: peak force", "max observer error"}));
  test::Workplace of_page;
  of_page.write("sweep.html", page);
  expect_works_in_chromium(of_page / "sweep.html", "campaign/sweep_in_browser.py");
}

}  // namespace
}  // namespace flinch
