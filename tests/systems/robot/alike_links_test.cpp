#include "systems/robot/alike_links.h"
#include "systems/robot/decompositions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "systems/config/robot_file.h"
#include "systems/framework/random.h"
#include "systems/robot/contact_jacobian.h"

namespace flinch {
namespace {

std::shared_ptr<const ParallelRobot> shipped_robot_named(const std::string& name) {
  return read_robot_file(std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/robots" / (name + ".yaml")).robot;
}

TEST(AlikeLinks, AreThoseOfLegsThatGetLonger) {
  for (const std::string name : {"hexapod_6ups", "planar_3rpr"}) {
    const std::vector<bool> alike = legs_of_alike_links(*shipped_robot_named(name));
    EXPECT_TRUE(std::all_of(alike.begin(), alike.end(), [](bool one) { return one; })) << name;
  }
  for (const std::string name : {"planar_3rrr", "planar_4rrr", "five_bar", "delta", "hexa_6rus"}) {
    const std::vector<bool> alike = legs_of_alike_links(*shipped_robot_named(name));
    EXPECT_TRUE(std::none_of(alike.begin(), alike.end(), [](bool one) { return one; })) << name;
  }
}

// Away from home too: a push across either link is the wrench of one across the other.
TEST(AlikeLinks, CannotBeToldApartAnywhere) {
  const auto robot = shipped_robot_named("hexapod_6ups");
  RandomGenerator random(1);
  for (int trial = 0; trial < 40; ++trial) {
    PlatformVector away(robot->dof());
    for (double& entry : away) entry = random.uniform(-0.08, 0.08);
    Kinematics at;
    robot->kinematics(robot->space().plus(robot->home_pose(), away), PlatformVector::Zero(robot->dof()), at);
    ASSERT_TRUE(at.valid);
    const int leg = trial % robot->legs();
    BodyId links[] = {BodyId::link1(leg), BodyId::link2(leg)};
    for (int pushed = 0; pushed < 2; ++pushed) {
      const auto across = [&](BodyId link) {
        const Eigen::Vector3d along = robot->point_on_body(at, link, robot->axis_point(link, 1.0)) -
                                      robot->point_on_body(at, link, robot->axis_point(link, 0.0));
        return Eigen::Matrix3d(Eigen::Matrix3d::Identity() - along * along.transpose() / along.squaredNorm());
      };
      const auto wrenches = [&](BodyId link, double fraction) {
        const ContactJacobian J = robot->contact_jacobian(at, link, robot->axis_point(link, fraction));
        return Eigen::MatrixXd(J.translation.transpose() * across(link));
      };
      const Eigen::VectorXd felt = wrenches(links[pushed], 0.4) * Eigen::Vector3d(30.0, -20.0, 10.0);
      const Eigen::MatrixXd other = wrenches(links[1 - pushed], 0.7);
      const Eigen::VectorXd force = other.colPivHouseholderQr().solve(felt);
      EXPECT_LT((other * force - felt).norm(), 1e-9 * felt.norm());
    }
  }
}

}  // namespace
}  // namespace flinch
