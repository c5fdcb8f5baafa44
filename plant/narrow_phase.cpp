#include "plant/narrow_phase.h"

#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <btBulletCollisionCommon.h>

#include <Eigen/Geometry>
#include <limits>

namespace flinch {

static_assert(sizeof(btScalar) == sizeof(double), "Bullet must be compiled in double precision");

namespace {

btVector3 bullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Eigen::Vector3d eigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

btTransform transform(const Eigen::Vector3d& origin, const Eigen::Matrix3d& axes) {
  const btMatrix3x3 rotation(axes(0, 0), axes(0, 1), axes(0, 2), axes(1, 0), axes(1, 1), axes(1, 2),
                             axes(2, 0), axes(2, 1), axes(2, 2));
  return btTransform(rotation, bullet(origin));
}

// Axes of which y points along `direction`; Bullet's capsules lie along y.
Eigen::Matrix3d axes_along(const Eigen::Vector3d& direction) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), direction).toRotationMatrix();
}

struct LocalShape {
  std::unique_ptr<btConvexShape> shape;
  btTransform in_body;
};

LocalShape make(const Sphere& sphere) {
  return {std::make_unique<btSphereShape>(sphere.radius),
          transform(sphere.centre, Eigen::Matrix3d::Identity())};
}

LocalShape make(const Capsule& capsule) {
  const Eigen::Vector3d axis = capsule.end - capsule.begin;
  const double length = axis.norm();
  if (length == 0.0) return make(Sphere{.centre = capsule.begin, .radius = capsule.radius});
  return {std::make_unique<btCapsuleShape>(capsule.radius, length),
          transform(0.5 * (capsule.begin + capsule.end), axes_along(axis / length))};
}

LocalShape make(const Box& box) {
  auto shape = std::make_unique<btBoxShape>(bullet(box.half_lengths));
  shape->setMargin(0.0);  // else its edges are rounded inwards
  return {std::move(shape), transform(box.centre, box.axes)};
}

LocalShape make(const ConvexHull& hull) {
  auto shape = std::make_unique<btConvexHullShape>();
  for (const Eigen::Vector3d& point : hull.points) shape->addPoint(bullet(point), false);
  shape->setMargin(hull.margin);
  shape->recalcLocalAabb();
  return {std::move(shape), btTransform::getIdentity()};
}

/// The nearest points that Bullet reports.
struct Nearest final : btDiscreteCollisionDetectorInterface::Result {
  btVector3 normal_to_a{1.0, 0.0, 0.0};
  btVector3 on_b{0.0, 0.0, 0.0};
  double gap = std::numeric_limits<double>::infinity();

  void setShapeIdentifiersA(int, int) override {}
  void setShapeIdentifiersB(int, int) override {}
  void addContactPoint(const btVector3& normal, const btVector3& point, btScalar distance) override {
    normal_to_a = normal;
    on_b = point;
    gap = distance;
  }
};

}  // namespace

struct Solid::Convex {
  std::unique_ptr<btConvexShape> shape;
  btTransform in_body;

  btTransform at(const Placement& placement) const {
    return transform(placement.origin, placement.axes) * in_body;
  }
};

Solid::Solid(const Shape& shape) {
  LocalShape local = std::visit([](const auto& of) { return make(of); }, shape);
  convex_ = std::make_unique<const Convex>(Convex{std::move(local.shape), local.in_body});
}

Solid::~Solid() = default;
Solid::Solid(Solid&&) noexcept = default;
Solid& Solid::operator=(Solid&&) noexcept = default;

AxisBox Solid::box(const Placement& at) const noexcept {
  btVector3 low;
  btVector3 high;
  convex_->shape->getAabb(convex_->at(at), low, high);
  return {eigen(low), eigen(high)};
}

SurfaceGap nearest(const Solid& a, const Placement& at_a, const Solid& b, const Placement& at_b) noexcept {
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver penetration;
  btGjkPairDetector detector(a.convex_->shape.get(), b.convex_->shape.get(), &simplex, &penetration);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = a.convex_->at(at_a);
  input.m_transformB = b.convex_->at(at_b);
  Nearest found;
  detector.getClosestPoints(input, found, nullptr);
  return {found.gap, -eigen(found.normal_to_a), eigen(found.on_b + 0.5 * found.gap * found.normal_to_a)};
}

}  // namespace flinch
