#include "convert/urdf_joints.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "convert/closure_list.h"
#include "convert/conversion.h"
#include "convert/legs_of_robot.h"
#include "convert/urdf_text.h"
#include "systems/config/config_file.h"
#include "systems/config/robot_file.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

/// A shipped robot, its URDF as a viewer reads it, and its joints.
class ShownRobot : public ::testing::TestWithParam<const char*> {
 protected:
  static std::filesystem::path file() {
    return FLINCH_SOURCE_DIR "/apps/robots/" + std::string(GetParam()) + ".yaml";
  }
  ShownRobot()
      : robot(read_robot_file(file()).robot),
        legs(as_legs(*robot, read_config_file(file()), file())),
        joints(legs) {
    const UrdfTexts texts = urdf_texts(legs, 50.0);
    graph = read_model(texts.model, "robot.urdf");
    add_closures(texts.closures, "closures.yaml", graph);
  }

  /// Where the links of the tree are, one joint after the other.
  std::vector<Eigen::Isometry3d> links_at(const std::vector<double>& positions) const {
    std::map<std::string, double> by_name;
    for (std::size_t i = 0; i < positions.size(); ++i) by_name[joints.names()[i]] = positions[i];
    std::vector<Eigen::Isometry3d> links(graph.bodies.size(), Eigen::Isometry3d::Identity());
    for (const GraphJoint& joint : graph.joints) {
      if (joint.closes) continue;
      Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
      if (joint.kind == GraphJoint::Kind::revolute)
        motion.linear() = Eigen::AngleAxisd(by_name.at(joint.name), joint.axis).toRotationMatrix();
      if (joint.kind == GraphJoint::Kind::prismatic)
        motion.translation() = by_name.at(joint.name) * joint.axis;
      links[joint.child] = links[joint.parent] * joint.in_parent * motion * joint.in_child.inverse();
    }
    return links;
  }

  /// By how much the loops are open [m].
  double gap_at(const std::vector<double>& positions) const {
    const std::vector<Eigen::Isometry3d> links = links_at(positions);
    double widest = 0.0;
    for (const GraphJoint& joint : graph.joints) {
      if (!joint.closes) continue;
      const Eigen::Vector3d here = (links[joint.parent] * joint.in_parent).translation(),
                            there = (links[joint.child] * joint.in_child).translation();
      widest = std::max(widest, (here - there).norm());
    }
    return widest;
  }

  std::shared_ptr<const ParallelRobot> robot;
  LegsParameters legs;
  UrdfJoints joints;
  BodyGraph graph;
};

INSTANTIATE_TEST_SUITE_P(Robots, ShownRobot,
                         ::testing::Values("planar_3rrr", "five_bar", "hexapod_6ups", "delta", "hexa_6rus",
                                           "linapod_6pus", "planar_3rpr", "planar_4rrr", "tricept"),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(ShownRobot, HasItsLoopsClosedAtHomeAndWhereverThePlatformIs) {
  EXPECT_LT(gap_at(joints.at_home()), 1e-9);
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-0.03, 0.03);
  std::vector<double> positions, before = joints.at_home();
  for (int trial = 0; trial < 5; ++trial) {
    Configuration pose = robot->home_pose();
    for (Eigen::Index i = 0; i < robot->space().translations(); ++i) pose[i] += uniform(generator);
    ASSERT_TRUE(joints.find(pose, positions));
    EXPECT_LT(gap_at(positions), 1e-8);
    EXPECT_NE(positions, before);
    before = positions;
  }
}

TEST(UrdfJoints, AreNotFoundWhereTheLegsDoNotReach) {
  const std::filesystem::path file = FLINCH_SOURCE_DIR "/apps/robots/planar_3rrr.yaml";
  const auto robot = read_robot_file(file).robot;
  Configuration far = robot->home_pose();
  far[0] += 10.0;
  std::vector<double> positions;
  EXPECT_FALSE(UrdfJoints(as_legs(*robot)).find(far, positions));
}

}  // namespace
}  // namespace flinch
