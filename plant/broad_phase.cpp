#include "plant/broad_phase.h"

#include <btBulletCollisionCommon.h>

#include <cstddef>

namespace flinch {

static_assert(sizeof(btScalar) == sizeof(double), "Bullet must be compiled in double precision");

namespace {

// The pylon as a capsule along z: far longer than wide, so that the plane of motion cuts its cylinder.
constexpr double pylon_height = 2.0;

double length(const PlanarCapsule& capsule) { return (capsule.end - capsule.begin).norm(); }

// Bullet's capsules lie along their own y axis about their centre.
btTransform transform(const Eigen::Vector2d& centre, const Eigen::Vector2d& y_axis) {
  const btMatrix3x3 rotation(y_axis.y(), y_axis.x(), 0.0, -y_axis.x(), y_axis.y(), 0.0, 0.0, 0.0, 1.0);
  return btTransform(rotation, btVector3(centre.x(), centre.y(), 0.0));
}

BroadPhase::Box box(const btCollisionShape& shape, const btTransform& pose) {
  btVector3 low;
  btVector3 high;
  shape.getAabb(pose, low, high);
  return {{low.x(), low.y()}, {high.x(), high.y()}};
}

btCapsuleShape link(const BenchShapes& shapes, const PlanarMotion& home, BodyId body) {
  return {shapes.link_radius, length(shapes.body(home, body))};
}

}  // namespace

struct BroadPhase::Shapes {
  Shapes(const BenchShapes& shapes, const PlanarMotion& home)
      : platform(shapes.platform_radius),
        pylon(shapes.pylon_radius, pylon_height),
        links{link(shapes, home, BodyId::from_index(1)), link(shapes, home, BodyId::from_index(2)),
              link(shapes, home, BodyId::from_index(3)), link(shapes, home, BodyId::from_index(4)),
              link(shapes, home, BodyId::from_index(5)), link(shapes, home, BodyId::from_index(6))} {}

  btSphereShape platform;
  btCapsuleShapeZ pylon;
  std::array<btCapsuleShape, 6> links;
};

BroadPhase::BroadPhase(const BenchShapes& shapes, const PlanarMotion& home)
    : shapes_(std::make_unique<const Shapes>(shapes, home)) {}

BroadPhase::~BroadPhase() = default;

BroadPhase::Boxes BroadPhase::boxes(const PlanarMotion& motion,
                                    const PylonMotion& pylon_motion) const noexcept {
  const Eigen::Vector2d x_axis = Eigen::Vector2d::UnitX();
  Boxes boxes;
  boxes[0] = box(shapes_->platform, transform(motion.pose.head<2>(), x_axis));
  for (std::size_t i = 0; i < 3; ++i) {
    const PlanarLeg& leg = motion.legs[i].leg;
    boxes[1 + 2 * i] =
        box(shapes_->links[2 * i], transform(0.5 * (leg.base_joint + leg.passive_joint), leg.u1));
    boxes[2 + 2 * i] =
        box(shapes_->links[2 * i + 1], transform(0.5 * (leg.passive_joint + leg.coupling_joint), leg.u2));
  }
  boxes[pylon] = box(shapes_->pylon, transform(pylon_motion.position, x_axis));
  return boxes;
}

}  // namespace flinch
