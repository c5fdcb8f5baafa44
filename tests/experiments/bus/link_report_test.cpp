#include "experiments/bus/link_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A second on a link with which nothing is wrong.
LinkReport good_report() {
  LinkReport report;
  for (int i = 0; i < 1000; ++i) {
    report.times.round_trip.add(200us);
    report.times.age.add(300us);
    report.times.interval.add(1ms);
    report.loop.lateness.add(5us);
  }
  report.link.received = 1000;
  report.link.robot_id = 1;
  report.robots = {{1, "left"}};
  report.loop.ticks = 1000;
  return report;
}

TEST(LinkReport, HasNothingAgainstAGoodLink) {
  EXPECT_THAT(good_report().objections(), IsEmpty());
  EXPECT_THAT(good_report().table(), HasSubstr("link: good for control at 1 kHz"));
  const auto json = nlohmann::json::parse(good_report().json());
  EXPECT_EQ(json["good"], true);
  EXPECT_EQ(json["received"], 1000);
  EXPECT_EQ(json["round_trip"]["count"], 1000);
  EXPECT_TRUE(json["platform"].is_null());
}

TEST(LinkReport, TellsWhereTheDrivesAreWhetherTheyTurnOrSlide) {
  LinkReport report = good_report();
  EXPECT_TRUE(nlohmann::json::parse(report.json())["active"].is_null());
  report.pose.joints.valid = true;
  report.pose.joints.active = Eigen::Vector3d(0.703, 0.71, 0.72);
  for (const DriveKind drives : {DriveKind::revolute, DriveKind::prismatic}) {
    report.pose.drives = drives;
    const auto json = nlohmann::json::parse(report.json());
    EXPECT_EQ(json["active"], nlohmann::json({0.703, 0.71, 0.72}));
    EXPECT_EQ(json["active_rad"], json["active"]) << "what was called so keeps its name";
  }
}

TEST(LinkReport, ObjectsToSeveralRobotsOfWhichNoneIsChosen) {
  LinkReport report = good_report();
  report.robots.push_back({2, "right"});
  EXPECT_THAT(report.objections(), ElementsAre(HasSubstr("there are 2 robots; choose one with --robot")));
  EXPECT_THAT(report.table(), HasSubstr("robots    left (0000000000000001), right (0000000000000002)"));
  report.is_chosen = true;
  EXPECT_THAT(report.objections(), IsEmpty());
  const auto json = nlohmann::json::parse(report.json());
  EXPECT_EQ(json["robot"], "0000000000000001");
  EXPECT_EQ(json["robots"][1]["id"], "0000000000000002");
  EXPECT_EQ(json["robots"][1]["name"], "right");
}

TEST(LinkReport, SaysOfRobotsOfWhichNoneWasMeasuredOnlyThat) {
  LinkReport report;
  report.robots = {{1, "left"}, {2, ""}};
  EXPECT_THAT(report.objections(), ElementsAre(HasSubstr("there are 2 robots")));
  EXPECT_THAT(report.table(), HasSubstr("none was measured"));
  EXPECT_TRUE(nlohmann::json::parse(report.json())["robot"].is_null());
}

TEST(LinkReport, ObjectsToCommandsThatNobodyObeys) {
  LinkReport report = good_report();
  report.times.round_trip = {};
  EXPECT_THAT(report.objections(), ElementsAre(HasSubstr("the robot has obeyed none of our commands")));
  EXPECT_TRUE(nlohmann::json::parse(report.json())["round_trip"].is_null());
}

TEST(LinkReport, ObjectsToMoreThanOneSlowCommandInAHundred) {
  LinkReport report = good_report();
  for (int i = 0; i < 9; ++i) report.times.round_trip.add(3ms);
  EXPECT_THAT(report.objections(), IsEmpty());
  for (int i = 0; i < 9; ++i) report.times.round_trip.add(3ms);
  EXPECT_THAT(report.objections(), ElementsAre(HasSubstr("one command in a hundred takes more than")));
}

TEST(LinkReport, ObjectsToMoreThanOneLossInAThousand) {
  LinkReport report = good_report();
  report.link.lost = 1;
  report.loop.lost_periods = 1;
  EXPECT_THAT(report.objections(), IsEmpty());
  report.link.lost = 2;
  report.loop.lost_periods = 2;
  EXPECT_THAT(report.objections(),
              ElementsAre("2 of 1002 readings were lost", "2 ticks of this program were lost"));
}

}  // namespace
}  // namespace flinch
