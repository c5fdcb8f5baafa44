#include <limits>

#include "tests/systems/robot/random_motion.h"
#include "tests/systems/robot/reference_3rrr.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

class DifferentialKinematics : public BothGeometries {};
FLINCH_FOR_BOTH_GEOMETRIES(DifferentialKinematics);

TEST_P(DifferentialKinematics, ReducedConstraintsGiveTheSameJacobianAndDeterminants) {
  const auto legs = reference_legs(GetParam());
  Residual reduced("J_qa,x = -inv(B) A", 2e-14);
  Residual inverse("J_x,qa J_qa,x = I", 2e-14);
  Residual determinant_A("det A", 1e-15);
  Residual determinant_B("det B", 1e-15);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    Eigen::Matrix3d A;
    Eigen::Matrix3d B = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 3; ++i) {
      const ReferenceLeg& leg = legs[static_cast<std::size_t>(i)];
      const double qp = k.joints.passive[i];
      const double theta2 = leg.psi + k.joints.active[i] + qp;
      const Eigen::Vector2d e(std::cos(theta2), std::sin(theta2));
      const Eigen::Vector2d d = leg.coupling(pose) - pose.head<2>();
      A.row(i) = 2.0 * leg.l2 * Eigen::RowVector3d(e.x(), e.y(), d.x() * e.y() - d.y() * e.x());
      B(i, i) = -2.0 * leg.l1 * leg.l2 * std::sin(qp);
    }
    reduced.add(k.J_qa_x, Eigen::Matrix3d(-B.inverse() * A));
    inverse.add(Eigen::Matrix3d(k.J_x_qa * k.J_qa_x), Eigen::Matrix3d::Identity());
    determinant_A.add(k.det_A - A.determinant());
    determinant_B.add(k.det_B - B.determinant());
  }
}

TEST(KinematicsAtHome, HasThePublishedValues) {
  const PlanarRrr individual(rig_robot(RigGeometry::individual, RigFriction::none));
  Kinematics k;
  individual.kinematics(individual.home_pose(), PlatformVector::Zero(3), k);
  EXPECT_TRUE(k.valid);
  EXPECT_NEAR(k.det_A, -0.4519, 5e-5);
  EXPECT_NEAR(k.det_B, -0.2216, 5e-5);
  EXPECT_NEAR(k.sigma_kappa, 7.82, 5e-3);
  EXPECT_TRUE(
      drive_torques(k, Eigen::Vector3d(10, 0, 0)).isApprox(Eigen::Vector3d(-1.70, 3.27, -1.51), 2e-3));
  EXPECT_TRUE(
      drive_torques(k, Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(-1.78, -1.83, -1.74), 3e-3));
  EXPECT_TRUE(k.legs[1].base_joint.isApprox(Eigen::Vector2d(-0.35405, 0.59480), 1e-5));

  const PlanarRrr nominal(rig_robot(RigGeometry::nominal, RigFriction::none));
  nominal.kinematics(nominal.home_pose(), PlatformVector::Zero(3), k);
  EXPECT_NEAR(k.sigma_kappa, 7.79, 5e-3);
  Eigen::Matrix3d J;
  J << -0.17233, 0.32566, -0.15333, -0.27655, -0.01097, 0.28752, -1.79408, -1.79408, -1.79408;
  // One unit in the last printed digit: the printed rows are not exactly symmetric under 120 degree turns.
  EXPECT_LT((k.J_x_qa - J).lpNorm<Eigen::Infinity>(), 1e-5) << k.J_x_qa;
}

TEST(KinematicsAtHome, TurningTowardsPositivePhiApproachesTheSingularity) {
  const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::none));
  Kinematics k;
  const double expected[][3] = {
      {-29, -0.529, 0}, {-20, 0, 6.7}, {20, 0, 11.7}, {29, -0.214, 0}, {30, 0, 17.3}};
  for (const auto& [degrees, det_A, kappa] : expected) {
    robot.kinematics(Eigen::Vector3d(0, 0, degrees * std::numbers::pi / 180.0), PlatformVector::Zero(3), k);
    EXPECT_TRUE(det_A == 0 || std::abs(k.det_A - det_A) < 5.1e-4) << k.det_A;
    EXPECT_TRUE(kappa == 0 || std::abs(k.sigma_kappa - kappa) < 0.051) << k.sigma_kappa;
  }
}

bool finite(const Kinematics& k) {
  bool finite =
      k.pose.allFinite() && k.velocity.allFinite() && std::isfinite(k.det_A) && std::isfinite(k.det_B);
  for (const auto* J :
       {&k.J_qa_x, &k.J_qp_x, &k.J_qc_x, &k.J_x_qa, &k.dJ_qa_x, &k.dJ_qp_x, &k.dJ_qc_x, &k.dJ_x_qa}) {
    finite = finite && J->rows() == 3 && J->cols() == 3 && J->allFinite();
  }
  for (const auto* v :
       {&k.joints.active, &k.joints.passive, &k.joints.coupling, &k.rates.active, &k.rates.passive}) {
    finite = finite && v->size() == 3 && v->allFinite();
  }
  return finite && !std::isnan(k.sigma_kappa);
}

// Orientation at which det A changes sign while the platform stays at the origin.
double singular_orientation(const PlanarRrr& robot) {
  double regular = 0.5;
  double beyond = 1.2;
  Kinematics k;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (regular + beyond);
    robot.kinematics(Eigen::Vector3d(0, 0, middle), PlatformVector::Zero(3), k);
    (k.det_A < 0.0 ? regular : beyond) = middle;
  }
  return 0.5 * (regular + beyond);
}

TEST(SingularPose, OfTypeTwoIsReachableButNotValidAndFinite) {
  const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::test_rig));
  const Eigen::Vector3d singular(0, 0, singular_orientation(robot));
  const Eigen::Vector3d velocity(0.3, -0.2, 1.0);
  Kinematics k;
  robot.kinematics(singular, velocity, k);
  EXPECT_TRUE(k.reachable);
  EXPECT_FALSE(k.valid);
  EXPECT_TRUE(finite(k));
  EXPECT_NEAR(k.det_A, 0.0, 1e-12);
  EXPECT_GT(k.sigma_kappa, 1e6);
  EXPECT_EQ(k.J_x_qa, Eigen::Matrix3d::Zero());

  Dynamics dynamics;
  robot.dynamics(k, dynamics);
  EXPECT_TRUE(dynamics.valid);
  EXPECT_GT(Eigen::Matrix3d(dynamics.M_x).determinant(), 0.0);
  const auto acceleration =
      robot.acceleration(singular, velocity, Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(0, 0, 0));
  ASSERT_TRUE(acceleration.has_value());
  EXPECT_LT(acceleration->norm(), 1e4);
}

TEST(SingularPose, OfTypeOneOrOutOfReachIsNotValidAndFinite) {
  const PlanarRrr robot(rig_robot(RigGeometry::nominal, RigFriction::test_rig));
  const double stretched = 0.6829 - 0.107 - (0.5816 + 0.6198);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Kinematics k;
  Dynamics dynamics;
  for (const double x : {stretched, stretched - 1e-15, stretched + 1e-15, stretched - 0.1, nan, 1e300}) {
    robot.kinematics(Eigen::Vector3d(x, 0, 0), Eigen::Vector3d(1, 1, 1), k);
    EXPECT_FALSE(k.valid) << x;
    EXPECT_TRUE(finite(k)) << x;
    robot.dynamics(k, dynamics);
    EXPECT_TRUE(dynamics.M_x.allFinite() && dynamics.C_x.allFinite() && dynamics.F_fr_x.allFinite());
  }
  robot.kinematics(robot.home_pose(), Eigen::Vector3d(nan, 0, 0), k);
  EXPECT_FALSE(k.reachable);
  EXPECT_TRUE(finite(k));
  robot.dynamics(k, dynamics);
  EXPECT_FALSE(dynamics.valid);
}

TEST(SingularPose, LeavesNothingOfAnEarlierEvaluation) {
  const PlanarRrr robot(rig_robot(RigGeometry::nominal, RigFriction::none));
  Kinematics k;
  robot.kinematics(robot.home_pose(), Eigen::Vector3d(1, 1, 1), k);
  robot.kinematics(Eigen::Vector3d(9, 0, 0), Eigen::Vector3d(1, 1, 1), k);
  EXPECT_FALSE(k.reachable || k.valid);
  EXPECT_EQ(k.J_qa_x, Eigen::Matrix3d::Zero());
  EXPECT_EQ(k.rates.active, Eigen::Vector3d::Zero());
  EXPECT_EQ(k.sigma_kappa, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace flinch::test
