#include "systems/robot/link_segments.h"

#include "systems/robot/angles.h"
#include "tests/systems/robot/random_motion.h"
#include "tests/systems/robot/reference_3rrr.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

template <class Point>
Segment segment(const Point& begin, const Point& end) {
  return {begin, end};
}

double distance_to_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& begin,
                           const Eigen::Vector3d& end) {
  const Eigen::Vector3d along = end - begin;
  const double fraction = std::clamp(along.dot(point - begin) / along.squaredNorm(), 0.0, 1.0);
  return (begin + fraction * along - point).norm();
}

// Distance to a convex set is convex along a line, so that a ternary search finds its minimum.
double searched_distance(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1, const Eigen::Vector3d& b0,
                         const Eigen::Vector3d& b1) {
  double low = 0.0;
  double high = 1.0;
  const auto at = [&](double s) { return distance_to_segment(a0 + s * (a1 - a0), b0, b1); };
  for (int i = 0; i < 200; ++i) {
    const double third = (high - low) / 3.0;
    (at(low + third) < at(high - third) ? high : low) += at(low + third) < at(high - third) ? -third : third;
  }
  return std::min({at(0.5 * (low + high)), at(0.0), at(1.0)});
}

TEST(SegmentDistance, AgreesWithASearchInThePlaneAndInSpace) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Residual residual("segment distance against a search [m]", 1e-8);
  Residual ends("distance of the two closest points [m]", 1e-15);
  for (int trial = 0; trial < 3000; ++trial) {
    Eigen::Matrix<double, 3, 4> p;
    for (double& value : p.reshaped()) value = uniform(generator);
    const bool planar = trial % 2 == 0;
    if (planar) p.row(2).setZero();
    const int rows = planar ? 2 : 3;
    const SegmentDistance result = segment_distance(segment(p.col(0).head(rows), p.col(1).head(rows)),
                                                    segment(p.col(2).head(rows), p.col(3).head(rows)));
    residual.add(result.distance - searched_distance(p.col(0), p.col(1), p.col(2), p.col(3)));
    const Eigen::Vector3d on_a = p.col(0) + result.fraction_a * (p.col(1) - p.col(0));
    const Eigen::Vector3d on_b = p.col(2) + result.fraction_b * (p.col(3) - p.col(2));
    ends.add((on_a - on_b).norm() - result.distance);
  }
}

TEST(SegmentDistance, IsZeroWhereSegmentsCross) {
  const SegmentDistance crossing = segment_distance(segment(Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1)),
                                                    segment(Eigen::Vector2d(-1, 1), Eigen::Vector2d(3, -3)));
  EXPECT_NEAR(crossing.distance, 0.0, 1e-15);
  EXPECT_NEAR(crossing.fraction_a, 0.5, 1e-15);
  EXPECT_NEAR(crossing.fraction_b, 0.25, 1e-15);
}

TEST(SegmentDistance, ServesParallelAndCollinearSegments) {
  const auto distance = [](double x0, double y0, double x1, double y1) {
    return segment_distance(segment(Eigen::Vector2d(0, 0), Eigen::Vector2d(2, 0)),
                            segment(Eigen::Vector2d(x0, y0), Eigen::Vector2d(x1, y1)))
        .distance;
  };
  EXPECT_DOUBLE_EQ(distance(1, 0.5, 4, 0.5), 0.5);            // overlapping
  EXPECT_DOUBLE_EQ(distance(4, 0.5, 1, 0.5), 0.5);            // and running backwards
  EXPECT_DOUBLE_EQ(distance(5, 4, 9, 4), 5.0);                // beyond the end
  EXPECT_DOUBLE_EQ(distance(-4, 3, -6, 3), 5.0);              // before the beginning
  EXPECT_DOUBLE_EQ(distance(3, 0, 5, 0), 1.0);                // on one line, apart
  EXPECT_DOUBLE_EQ(distance(1, 0, 5, 0), 0.0);                // on one line, overlapping
  EXPECT_NEAR(distance(0, 0.5, 2, 0.5 + 1e-12), 0.5, 1e-12);  // nearly parallel
  EXPECT_NEAR(distance(0, -1e-9, 2, 1e-9), 0.0, 1e-9);        // nearly parallel and crossing
}

TEST(SegmentDistance, ServesSegmentsWithoutLength) {
  const Segment point = segment(Eigen::Vector2d(1, 3), Eigen::Vector2d(1, 3));
  const Segment line = segment(Eigen::Vector2d(0, 0), Eigen::Vector2d(2, 0));
  EXPECT_DOUBLE_EQ(segment_distance(point, line).distance, 3.0);
  EXPECT_DOUBLE_EQ(segment_distance(line, point).distance, 3.0);
  EXPECT_DOUBLE_EQ(segment_distance(point, point).distance, 0.0);
}

class SelfCollision : public BothGeometries {};
FLINCH_FOR_BOTH_GEOMETRIES(SelfCollision);

TEST_P(SelfCollision, DistanceIsTheSmallestOfAllPairsOfLinksOfDifferentLegs) {
  Residual residual("sigma_sc against a search over all pairs [m]", 1e-8);
  for (const auto& [pose, velocity] : motions) {
    const Kinematics k = kinematics_at(pose, velocity);
    double smallest = HUGE_VAL;
    for (int a = 1; a < 7; ++a) {
      for (int b = a + 1; b < 7; ++b) {
        if (BodyId::from_index(a).leg() == BodyId::from_index(b).leg()) continue;
        const Segment s = link_segment(k, BodyId::from_index(a));
        const Segment t = link_segment(k, BodyId::from_index(b));
        const auto in_space = [](const CartesianVector& v) { return Eigen::Vector3d(v[0], v[1], 0.0); };
        smallest = std::min(smallest, searched_distance(in_space(s.begin), in_space(s.end), in_space(t.begin),
                                                        in_space(t.end)));
      }
    }
    residual.add(self_collision_distance(robot, k) - smallest);
  }
}

// With omega_j the angle of the second link away from the coupling joint's radius, neighbouring coupling
// joints are nearest up to 60 degrees, and beyond a coupling joint is nearest to the neighbour's second link.
TEST_P(SelfCollision, DistanceHasAClosedFormInTheAnglesOfTheSecondLinks) {
  Residual residual("sigma_sc against its closed form [m]", 1e-15);
  const auto legs = reference_legs(GetParam());
  const double plateau = 0.107 * std::numbers::sqrt3;
  int below_plateau = 0;
  for (const auto& [pose, velocity] : random_motions(robot, 3000, 2)) {
    const Kinematics k = kinematics_at(pose, velocity);
    double omega = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double towards_platform = std::numbers::pi - k.joints.coupling[i];
      omega =
          std::max(omega, std::abs(wrap_angle(towards_platform - legs[static_cast<std::size_t>(i)].beta)));
    }
    const double beyond = omega - std::numbers::pi / 3.0;
    const double expected = beyond <= 0.0 ? plateau : plateau * std::cos(beyond);
    const double distance = self_collision_distance(robot, k);
    EXPECT_LE(distance, plateau + 1e-15);
    if (expected < 0.1) continue;
    if (beyond > 0.0) ++below_plateau;
    residual.add(distance - expected);
  }
  EXPECT_GT(below_plateau, 100);
}

TEST(SelfCollisionAtHome, HasThePublishedDistance) {
  const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::none));
  Kinematics k;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(3), k);
  EXPECT_NEAR(self_collision_distance(robot, k), 0.18533, 5e-6);
}

TEST(SelfCollisionAtHome, OutOfReachCountsAsCollision) {
  const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::none));
  Kinematics k;
  robot.kinematics(Eigen::Vector3d(9, 0, 0), PlatformVector::Zero(3), k);
  EXPECT_EQ(self_collision_distance(robot, k), 0.0);
}

}  // namespace
}  // namespace flinch::test
