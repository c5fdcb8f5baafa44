#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "experiments/report/experiment_report.h"
#include "experiments/report/report_page.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/body_regions.h"
#include "experiments/verdict/verdict.h"
#include "plant/obstacle_path.h"
#include "systems/config/config_file.h"
#include "systems/framework/recording.h"
#include "tests/experiments/report/chromium.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

/// Of as much of the scenario as is wanted.
Report report_of(const std::string& scenario_file, Time longest = Time::max()) {
  SimulatedScenario scenario = read_simulated_scenario(scenario_file);
  scenario.duration = std::min(scenario.duration, longest);
  const Recording recording = run_experiment(scenario, {{"command_line", "flinch run " + scenario_file}});
  return experiment_report(
      scenario, recording,
      judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits));
}

TEST(ExperimentPage, TellsWhereObstaclesAreThatMove) {
  SimulatedScenario scenario =
      read_simulated_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/platform_collision.yaml");
  const auto columns = [&] {
    const Recording recording = run_experiment(scenario);
    const Verdict verdict =
        judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits);
    return experiment_report(scenario, recording, verdict).columns;
  };
  EXPECT_EQ(columns().count("obstacle_1_x"), 0U) << "a fixed one";

  scenario.station.rig.obstacles[0] = std::make_shared<const MovingObstacle>(
      scenario.station.rig.obstacles[0]->form(),
      ObstaclePath({{.time = 0.2}, {.time = 0.4, .displacement = {-0.05, 0.02, 0.0}}}));
  const auto moving = columns();
  EXPECT_NEAR(moving.at("obstacle_1_x").at(100), 0.0, 1e-12);
  EXPECT_NEAR(moving.at("obstacle_1_x").at(300), -0.025, 1e-12);
  EXPECT_NEAR(moving.at("obstacle_1_y").at(300), 0.01, 1e-12);
  EXPECT_NEAR(moving.at("obstacle_1_x").back(), -0.05, 1e-12);
  EXPECT_EQ(moving.count("obstacle_1_z"), 0U) << "in a plane";
}

TEST(ExperimentPage, DrawsTheLyapunovFunctionOfWhatTheLawOfTheModeServes) {
  const Report report = report_of(FLINCH_SOURCE_DIR "/apps/scenarios/platform_reaction.yaml");
  const std::vector<double>& V = report.columns.at("energy_task_1");
  const std::vector<double>& rate = report.columns.at("energy_rate_task_1");
  const std::vector<double>& orientation = report.columns.at("energy_task_2");
  EXPECT_GE(orientation.at(400), 0.0) << "of the nominal law";
  const auto reacts =
      std::find_if(orientation.begin() + 400, orientation.end(), [](double E) { return std::isnan(E); });
  const auto later = static_cast<std::size_t>(reacts - orientation.begin()) + 50;
  EXPECT_TRUE(std::isnan(orientation.at(later))) << "a reaction of the platform has one task";
  EXPECT_NEAR(rate.at(later), (V.at(later) - V.at(later - 1)) / 1e-3, 1e-9);
  EXPECT_GE(orientation.back(), 0.0) << "of the place that it holds";
  EXPECT_EQ(
      report_of(FLINCH_SOURCE_DIR "/apps/scenarios/platform_collision.yaml").columns.count("energy_task_1"),
      0U)
      << "its laws serve no tasks";
}

/// Below a force that it never reaches nothing has a direction: the robot goes back.
TEST(ExperimentPage, TellsSinceWhenTheRobotGoesBackTheWayItCame) {
  SimulatedScenario scenario =
      read_simulated_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/platform_reaction.yaml");
  scenario.control.tasks.reaction.force_to_go_by = 1000.0;
  const Recording recording = run_experiment(scenario);
  const Verdict verdict = judge(recording, scenario.robot.robot->space(), {}, {});
  const Report report = experiment_report(scenario, recording, verdict);
  const auto lane = std::find_if(report.lanes.begin(), report.lanes.end(),
                                 [](const ReportLane& each) { return each.name == "reaction"; });
  ASSERT_NE(lane, report.lanes.end());
  const auto begin =
      std::find_if(lane->state.begin(), lane->state.end(), [](int state) { return state > 0; });
  ASSERT_NE(begin, lane->state.end());
  EXPECT_EQ(lane->states.at(static_cast<std::size_t>(*begin)),
            "goes back the way it came, class or direction not known");
  const TaskBegin& told = verdict.contacts.at(0).reaction_tasks.at(0);
  EXPECT_EQ(told.task.kind, ReactionKind::retreat);
  EXPECT_NEAR(told.time, report.start + report.period * static_cast<double>(begin - lane->state.begin()),
              1e-9);
}

/// The lines across a chart, by name.
std::map<std::string, double> lines_across(const Report& report, const std::string& chart) {
  std::map<std::string, double> lines;
  for (const ReportBound& bound : report.bounds) {
    if (bound.chart == chart) lines[bound.name] = bound.value;
  }
  return lines;
}

const ReportLane* lane_of(const Report& report, const std::string& name) {
  const auto found = std::find_if(report.lanes.begin(), report.lanes.end(),
                                  [&name](const ReportLane& lane) { return lane.name == name; });
  return found == report.lanes.end() ? nullptr : &*found;
}

/// The names of the states in which a lane ever is.
std::set<std::string> states_of(const ReportLane& lane) {
  std::set<std::string> names;
  for (const int state : lane.state) names.insert(lane.states.at(static_cast<std::size_t>(state)));
  return names;
}

/// A retreat that would end in a leg, its laws and limits in place of those of the file.
Report retreat(const std::string& law, const std::string& limits) {
  const std::filesystem::path file = FLINCH_SOURCE_DIR "/apps/scenarios/reaction_near_itself.yaml";
  std::string text = read_config_file(file);
  for (const auto& [from, to] : {std::pair<std::string, std::string>("[torque_reaction]", "[" + law + "]"),
                                 {"limits: {keep: never}", "limits: {" + limits + "}"}})
    text.replace(text.find(from), from.size(), to);
  const SimulatedScenario scenario = parse_simulated_scenario(text, file);
  const Recording recording = run_experiment(scenario);
  return experiment_report(
      scenario, recording,
      judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits));
}

TEST(ExperimentPage, ShowsOfALevelThatLeadsItsConstraintsWhereItLeadsThem) {
  const Report report = retreat("torque_reaction", "keep: never");
  ASSERT_NE(lane_of(report, "constraints"), nullptr);
  EXPECT_EQ(states_of(*lane_of(report, "constraints")).count("self-collision"), 1U);
  EXPECT_EQ(lane_of(report, "limits"), nullptr) << "nobody keeps them";
  EXPECT_EQ(lines_across(report, "sigma_sc"),
            (std::map<std::string, double>{
                {"activation value", 0.178}, {"safety value", 0.17}, {"torque gate closes", 0.05}}));
  EXPECT_EQ(report.columns.count("sigma_sc_reference"), 1U);
}

TEST(ExperimentPage, ShowsOfTheStrictLevelTheLimitsThatItKeepsAndNoActivation) {
  const Report report = retreat("strict_reaction", "keep: always");
  EXPECT_EQ(lane_of(report, "constraints"), nullptr);
  EXPECT_EQ(report.columns.count("sigma_kappa_reference") + report.columns.count("sigma_sc_reference"), 0U);
  ASSERT_NE(lane_of(report, "limits"), nullptr);
  const std::set<std::string> states = states_of(*lane_of(report, "limits"));
  EXPECT_EQ(states.count("kept") + states.count("self-collision"), 2U);
  EXPECT_EQ(lines_across(report, "sigma_kappa"),
            (std::map<std::string, double>{{"limit that is kept", 15.0}}));
  EXPECT_EQ(lines_across(report, "sigma_sc"),
            (std::map<std::string, double>{{"limit that is kept", 0.17}, {"torque gate closes", 0.05}}));
}

TEST(ExperimentPage, ShowsTheLimitsThatTheDefaultReactionKeepsOfAnyMechanism) {
  for (const std::string name : {"platform_collision", "five_bar_collision", "hexapod_collision"}) {
    const Report report = report_of(FLINCH_SOURCE_DIR "/apps/scenarios/" + name + ".yaml");
    ASSERT_NE(lane_of(report, "limits"), nullptr) << name;
    const std::set<std::string> states = states_of(*lane_of(report, "limits"));
    EXPECT_EQ(states.count("not kept") + states.count("kept"), 2U) << name << ": from the contact on";
    EXPECT_EQ(lane_of(report, "constraints"), nullptr) << name;
    EXPECT_EQ(lines_across(report, "sigma_sc").count("limit that is kept, torque gate closes"), 1U) << name;
    EXPECT_EQ(lines_across(report, "sigma_kappa").size(), 0U) << name;
  }
}

TEST(ExperimentPage, TellsWhoseForceLimitDecidesAndWhereItIsFrom) {
  SimulatedScenario scenario =
      read_simulated_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/platform_collision.yaml");
  scenario.force_limits = force_limits_of(*find_body_region("lower_leg"));
  scenario.force_limits.transient = 100.0;
  scenario.force_limits.transient_source = "set by the scenario";
  const Recording recording = run_experiment(scenario);
  const auto contact_by = [&](const ForceLimits& limits) {
    const Verdict verdict = judge(recording, scenario.robot.robot->space(), scenario.expected, limits);
    EXPECT_GT(verdict.contacts.at(0).over_limit, 0.0);
    const ReportContact shown = experiment_report(scenario, recording, verdict).contacts.at(0);
    EXPECT_EQ(shown.over_limit, verdict.contacts.at(0).over_limit);
    return shown;
  };
  const ReportContact high = contact_by(scenario.force_limits);
  EXPECT_EQ(high.limit_name, "transient, lower leg; set by the scenario");
  EXPECT_EQ(high.force_limit, 100.0);
  EXPECT_EQ(high.lasting_force, std::nullopt);

  ForceLimits at_once = force_limits_of(*find_body_region("lower_leg"));
  at_once.quasi_static = 20.0;
  at_once.transient_duration = 0.02;
  const ReportContact lasting = contact_by(at_once);
  EXPECT_EQ(lasting.limit_name,
            "quasi-static, lower leg; ISO/TS 15066:2016 Table A.2, from secondary sources");
  ASSERT_TRUE(lasting.lasting_force);
  EXPECT_GT(*lasting.lasting_force, 20.0);
}

/// How many samples of a column have a value.
std::ptrdiff_t shown(const Report& report, const std::string& column) {
  const std::vector<double>& values = report.columns.at(column);
  return std::count_if(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/// Of a scenario that lists no locators, and so has all of them.
TEST(ExperimentPage, ShowsWhatIsTouchedHowFarOffItIsPlacedAndTheParticles) {
  const Report report = report_of(FLINCH_SOURCE_DIR "/apps/scenarios/second_link_collision.yaml");
  EXPECT_GT(shown(report, "probability_leg1_link2"), 0);
  EXPECT_GT(shown(report, "location_error"), 0);
  EXPECT_GT(shown(report, "force_error"), 0);
  for (int i = 1; i <= most_page_particles; ++i) {
    const std::string particle = "particle_" + std::to_string(i);
    EXPECT_GT(shown(report, particle + "_x"), 0) << particle;
    EXPECT_EQ(shown(report, particle + "_x"), shown(report, particle + "_y")) << particle;
  }
}

/// Above a limit that no wrench passes nothing is explained by a single contact.
TEST(ExperimentPage, TellsOfWrenchesThatNoSingleContactExplains) {
  SimulatedScenario scenario =
      read_simulated_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/second_link_collision.yaml");
  const auto told = [&scenario](double largest_residual) {
    scenario.control.isolation.model_classifier.largest_residual = largest_residual;
    const Recording recording = run_experiment(scenario);
    const Report report =
        experiment_report(scenario, recording, judge(recording, scenario.robot.robot->space(), {}, {}));
    const auto lane = std::find_if(report.lanes.begin(), report.lanes.end(),
                                   [](const ReportLane& each) { return each.name == "taken for"; });
    EXPECT_EQ(lane->states.back(), "several contacts");
    const auto last = static_cast<int>(lane->states.size()) - 1;
    const bool in_lane = std::find(lane->state.begin(), lane->state.end(), last) != lane->state.end();
    EXPECT_EQ(in_lane, report.contacts.at(0).several_contacts);
    return in_lane;
  };
  EXPECT_TRUE(told(1e-12));
  EXPECT_FALSE(told(15.0));
}

TEST(ExperimentPage, WorksInChromium) {
  const test::TemporaryFolder folder;
  const std::filesystem::path page = folder / "page.html";
  write_report_page(report_of(FLINCH_SOURCE_DIR "/apps/scenarios/platform_collision.yaml"), page);
  expect_works_in_chromium(page);
}

TEST(ExperimentPage, OfAHexapodWorksInChromium) {
  const test::TemporaryFolder folder;
  const std::filesystem::path page = folder / "page.html";
  write_report_page(report_of(FLINCH_SOURCE_DIR "/apps/scenarios/hexapod_collision.yaml"), page);
  expect_works_in_chromium(page);
}

/// Every scenario that ships has a page that the check of its names and lengths lets pass.
TEST(ExperimentPage, FitsEveryScenario) {
  for (const auto& entry : std::filesystem::directory_iterator(FLINCH_SOURCE_DIR "/apps/scenarios")) {
    const Report report = report_of(entry.path().string(), 6s);
    check_report(report);
    EXPECT_TRUE(report.good) << entry.path();
    const bool is_touched =
        std::any_of(report.contacts.begin(), report.contacts.end(),
                    [](const ReportContact& contact) { return contact.object != "push"; });
    EXPECT_EQ(is_touched, !report.obstacles.empty()) << entry.path();
  }
}

/// When the lane goes from touching to free for the last time before `end` of the run; none: it never does.
std::optional<double> end_of_touching(const Report& report, const ReportLane& lane) {
  std::optional<double> end;
  for (std::size_t k = 1; k < lane.state.size(); ++k) {
    if (lane.state[k - 1] == 1 && lane.state[k] == 0)
      end = report.start + static_cast<double>(k) * report.period;
  }
  return end;
}

TEST(ExperimentPage, ShowsTheContactsForAsLongAsItSaysThatTheyLasted) {
  for (const std::string name : {"platform_collision", "first_link_collision", "second_link_collision"}) {
    const Report report = report_of(FLINCH_SOURCE_DIR "/apps/scenarios/" + name + ".yaml");
    ASSERT_FALSE(report.contacts.empty()) << name;
    ASSERT_EQ(report.lanes.front().name, "contact");
    const std::optional<double> end = end_of_touching(report, report.lanes.front());
    ASSERT_TRUE(end && report.contacts.back().removed) << name;
    EXPECT_NEAR(*end, *report.contacts.back().removed, 1e-9) << name;
  }
}

}  // namespace
}  // namespace flinch
