#include <gtest/gtest.h>

#include <random>

#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/systems/robot/residual.h"
#include "tests/systems/robot/written_legs.h"

// Robots that have closed forms of their own are the same as robots of legs, to rounding.
namespace flinch::test {
namespace {

constexpr double rounding = 1e-12;  // relative where above 1

class SameRobot {
 public:
  SameRobot(const ParallelRobot& legs, const ParallelRobot& own) : legs_(legs), own_(own) {}

  void compare(const PlatformVector& region, const PlatformVector& velocity) {
    ASSERT_EQ(legs_.dof(), own_.dof());
    ASSERT_EQ(legs_.description().drives, own_.description().drives);
    ASSERT_EQ(legs_.body_count(), own_.body_count());
    ASSERT_LT(own_.space().difference(legs_.home_pose(), own_.home_pose()).norm(), 1e-14);
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto within = [&](PlatformVector widths) {
      for (double& entry : widths) entry *= uniform(generator);
      return widths;
    };
    int reached = 0;
    for (int i = 0; i < 300; ++i) {
      const Configuration pose = own_.space().plus(own_.home_pose(), within(region));
      const PlatformVector v = within(velocity);
      Kinematics a, b;
      legs_.kinematics(pose, v, a);
      own_.kinematics(pose, v, b);
      ASSERT_EQ(a.reachable, b.reachable);
      if (!b.valid || b.sigma_kappa > 100.0) continue;  // whose digits are lost in both
      ++reached;
      compare_at(a, b);
    }
    EXPECT_GT(reached, 200);
  }

 private:
  template <class A, class B>
  static void add(Residual& residual, const A& a, const B& b) {
    ASSERT_EQ(a.rows(), b.rows());
    ASSERT_EQ(a.cols(), b.cols());
    if (a.size() == 0) return;
    residual.add((a - b).template lpNorm<Eigen::Infinity>() /
                 std::max(1.0, b.template lpNorm<Eigen::Infinity>()));
  }

  void compare_at(const Kinematics& a, const Kinematics& b) {
    add(joints_, a.joints.active, b.joints.active);
    if (legs_.passive_joints() > 0) {
      add(joints_, a.joints.passive, b.joints.passive);
      add(maps_, a.J_qp_x, b.J_qp_x);
      add(rates_, a.dJ_qp_x, b.dJ_qp_x);
    }
    add(maps_, a.J_qa_x, b.J_qa_x);
    add(maps_, a.J_x_qa, b.J_x_qa);
    add(rates_, a.dJ_qa_x, b.dJ_qa_x);
    add(rates_, a.dJ_x_qa, b.dJ_x_qa);
    Dynamics da, db;
    legs_.dynamics(a, da);
    own_.dynamics(b, db);
    add(dynamics_, da.M_x, db.M_x);
    add(dynamics_, da.C_x * a.velocity, db.C_x * b.velocity);
    add(dynamics_, da.C_x.transpose() * a.velocity, db.C_x.transpose() * b.velocity);
    add(dynamics_, da.g_x, db.g_x);
    add(dynamics_, da.F_fr_x, db.F_fr_x);
    const CartesianVector point = Eigen::Vector3d(0.07, -0.04, 0.11).head(own_.space_dimension());
    for (int i = 0; i < own_.body_count(); ++i) {
      const BodyId body = BodyId::from_index(i);
      add(points_, legs_.point_on_body(a, body, point), own_.point_on_body(b, body, point));
      const ContactJacobian ca = legs_.contact_jacobian(a, body, point);
      const ContactJacobian cb = own_.contact_jacobian(b, body, point);
      add(points_, ca.translation, cb.translation);
      add(points_, ca.rotation, cb.rotation);
      add(points_, ca.d_translation, cb.d_translation);
      add(points_, ca.d_rotation, cb.d_rotation);
    }
  }

  const ParallelRobot& legs_;
  const ParallelRobot& own_;
  Residual joints_{"joint positions", rounding};
  Residual maps_{"maps and inverse", rounding};
  Residual rates_{"their rates", rounding};
  Residual dynamics_{"M, C v, C^T v, g, F_fr", rounding};
  Residual points_{"points, contact Jacobians and rates", rounding};
};

template <class Parameters>
void make_uneven(Parameters& robot, const LinkBody& link1, const LinkBody& link2) {
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    robot.legs[i].inertia = base_parameters(link1, link2, robot.legs[i].link1_length);
    robot.legs[i].rotor_inertia = 0.02 * static_cast<double>(i + 1);
    robot.legs[i].active_friction = {.viscous = 0.5, .coulomb = 0.1 * static_cast<double>(i + 1)};
    robot.legs[i].passive_friction = {.viscous = 0.01, .coulomb = 0.02};
  }
}

TEST(LegsAsClosedForms, ArePlanarRrr) {
  for (const RigGeometry geometry : {RigGeometry::individual, RigGeometry::nominal}) {
    PlanarRrrParameters p = rig_robot(geometry, RigFriction::none);
    make_uneven(p, rig_link1(), rig_link2());
    SameRobot(legs_robot_in(legs_text(p, rig_link1(), rig_link2())), PlanarRrr(p))
        .compare(Eigen::Vector3d(0.2, 0.2, 0.3), Eigen::Vector3d(1.0, 1.0, 2.0));
  }
}

TEST(LegsAsClosedForms, AreFiveBars) {
  for (const FiveBarElbows elbows : {FiveBarElbows::outward, FiveBarElbows::inward}) {
    FiveBarParameters p = five_bar_robot(elbows);
    make_uneven(p, five_bar_link1(), five_bar_link2());
    SameRobot(legs_robot_in(legs_text(p, five_bar_link1(), five_bar_link2())), FiveBar(p))
        .compare(Eigen::Vector2d(0.09, 0.055), Eigen::Vector2d(0.6, 0.6));
  }
}

TEST(LegsAsClosedForms, AreHexapods) {
  HexapodParameters p = hexapod_robot(HexapodPayload::eccentric, HexapodFriction::ball_screws);
  p.drive_armature = 3.0;
  for (std::size_t i = 0; i < p.legs.size(); ++i) p.legs[i].mass_scale = 1.0 + 0.1 * static_cast<double>(i);
  Eigen::Matrix<double, 6, 1> region, velocity;
  region << 0.1, 0.1, 0.08, 0.25, 0.25, 0.25;
  velocity << 0.6, 0.6, 0.6, 3.0, 3.0, 3.0;
  SameRobot(legs_robot_in(legs_text(p)), Hexapod(p)).compare(region, velocity);
}

}  // namespace
}  // namespace flinch::test
