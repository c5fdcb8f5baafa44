#include "experiments/report/drawn_robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

#include "experiments/report/report_page.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/robot/rotation.h"
#include "tests/experiments/report/chromium.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

struct Case {
  const char* name;
  std::shared_ptr<const ParallelRobot> robot;
};

void PrintTo(const Case& drawn, std::ostream* out) { *out << drawn.name; }

const Case planar{"planar_3rrr",
                  std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::none))};
const Case five_bar{"five_bar", std::make_shared<FiveBar>(five_bar_robot())};
const Case hexapod{"hexapod_6ups", std::make_shared<Hexapod>(hexapod_robot())};

/// A slow circle about the home pose that turns a little, with a force while the platform is on one side.
Report circling(const ParallelRobot& robot) {
  Report report;
  report.title = "Circle";
  report.kind = "drawing";
  report.period = 1e-2;
  const ConfigurationSpace& space = robot.space();
  const std::vector<std::string> turned =
      space.rotations() == 3 ? std::vector<std::string>{"pose_qw", "pose_qx", "pose_qy", "pose_qz"}
                             : std::vector<std::string>{"pose_phi"};
  for (int k = 0; k < 200; ++k) {
    const double angle = 0.01 * M_PI * k;
    report.columns["speed"].push_back(0.09);
    PlatformVector xi = PlatformVector::Constant(space.dimension(), 0.1 * std::sin(angle));
    xi[0] = 0.03 * std::cos(angle);
    xi[1] = 0.03 * std::sin(angle);
    if (space.translations() == 3) xi[2] = 0.02 * std::sin(2 * angle);
    const Configuration pose = space.plus(robot.home_pose(), xi);
    constexpr std::array axes{"x", "y", "z"};
    for (int i = 0; i < space.translations(); ++i) {
      const std::string axis = axes[static_cast<std::size_t>(i)];
      report.columns["pose_" + axis].push_back(pose[i]);
      report.columns["contact_1_" + axis].push_back(pose[i] + (i == 0 ? 0.1 : 0.0));
      report.columns["contact_1_force_" + axis].push_back(k > 60 && k < 120 ? -40.0 - 10.0 * i : 0.0);
    }
    for (int i = space.translations(); i < space.stored(); ++i) {
      report.columns[turned[static_cast<std::size_t>(i - space.translations())]].push_back(pose[i]);
    }
  }
  report.robot = drawn_robot(robot);
  add_elbows(robot, report);
  return report;
}

Eigen::Vector3d vector(const ReportPoint& point) { return {point[0], point[1], point[2]}; }

Eigen::Vector3d vector(const Report& report, const std::string& prefix, std::size_t sample) {
  const auto entry = [&](const char* axis) {
    const auto column = report.columns.find(prefix + axis);
    return column == report.columns.end() ? 0.0 : column->second[sample];
  };
  return {entry("x"), entry("y"), entry("z")};
}

/// As the page turns the platform.
Eigen::Matrix3d rotation(const Report& report, std::size_t sample) {
  const auto entry = [&](const char* name) { return report.columns.at(name)[sample]; };
  if (report.columns.contains("pose_qw")) {
    return rotation_matrix({entry("pose_qw"), entry("pose_qx"), entry("pose_qy"), entry("pose_qz")});
  }
  if (!report.columns.contains("pose_phi")) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(entry("pose_phi"), Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

class DrawnRobot : public testing::TestWithParam<Case> {};

TEST_P(DrawnRobot, HasLegsWhoseLinksKeepTheirShape) {
  const ParallelRobot& robot = *GetParam().robot;
  const Report report = circling(robot);
  ASSERT_EQ(report.robot->legs.size(), static_cast<std::size_t>(robot.legs()));
  for (std::size_t k = 0; k < report.sample_count(); ++k) {
    for (int i = 0; i < robot.legs(); ++i) {
      const ReportLeg& leg = report.robot->legs[static_cast<std::size_t>(i)];
      const Eigen::Vector3d elbow = vector(report, "elbow_" + std::to_string(i + 1) + "_", k);
      const Eigen::Vector3d coupling =
          vector(report, "pose_", k) + rotation(report, k) * vector(leg.coupling);
      const auto* const link1 = std::get_if<Capsule>(&robot.body(BodyId::link1(i)).shapes.front());
      ASSERT_NE(link1, nullptr);
      EXPECT_NEAR((elbow - vector(leg.base)).norm(), (link1->end - link1->begin).norm(), 1e-12);
      if (robot.drive_kind(i) == DriveKind::prismatic) {  // the leg is straight
        EXPECT_LT((coupling - vector(leg.base)).cross(elbow - vector(leg.base)).norm(), 1e-12);
      } else {
        const auto* const link2 = std::get_if<Capsule>(&robot.body(BodyId::link2(i)).shapes.front());
        EXPECT_NEAR((coupling - elbow).norm(), (link2->end - link2->begin).norm(), 1e-12);
      }
    }
  }
}

TEST_P(DrawnRobot, IsOneThatThePageKnows) { EXPECT_NO_THROW(check_report(circling(*GetParam().robot))); }

TEST_P(DrawnRobot, WorksInChromium) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder / "page.html";
  write_report_page(circling(*GetParam().robot), path);
  expect_works_in_chromium(path);
}

INSTANTIATE_TEST_SUITE_P(Every, DrawnRobot, testing::Values(planar, five_bar, hexapod),
                         [](const auto& drawn) { return std::string(drawn.param.name); });

TEST(DrawnObstacle, IsTheHullOfItsCornersWhereverItIsTurned) {
  Box box{.half_lengths = {0.1, 0.1, 0.05}};
  box.axes = Eigen::AngleAxisd(M_PI / 4.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const ReportObstacle of_box = drawn_obstacle("box", box, {1.0, 2.0, 3.0});
  ConvexHull hull;
  for (const double z : {-0.05, 0.05}) {
    for (const auto& [x, y] : {std::pair(0.0, -1.0), {-1.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}})
      hull.points.emplace_back(0.1 * M_SQRT2 * x, 0.1 * M_SQRT2 * y, z);
  }
  const ReportObstacle of_hull = drawn_obstacle("hull", hull, {1.0, 2.0, 3.0});
  EXPECT_EQ(of_box.radius, 0.0);
  EXPECT_EQ(of_hull.radius, 0.0);
  ASSERT_EQ(of_box.points.size(), 8U);
  ASSERT_EQ(of_hull.points.size(), 8U);
  for (const ReportPoint& corner : of_box.points) {
    EXPECT_TRUE(std::any_of(of_hull.points.begin(), of_hull.points.end(), [&](const ReportPoint& point) {
      return (vector(point) - vector(corner)).norm() < 1e-14;
    }));
  }
}

TEST(DrawnRobotOutOfReach, HasNoElbows) {
  Report report = circling(*planar.robot);
  report.columns["pose_x"][3] = 9.0;
  add_elbows(*planar.robot, report);
  EXPECT_TRUE(std::isnan(report.columns["elbow_1_x"][3]));
  EXPECT_FALSE(std::isnan(report.columns["elbow_1_x"][4]));
}

}  // namespace
}  // namespace flinch
