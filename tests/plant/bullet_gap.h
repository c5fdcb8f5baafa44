#pragma once

#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "plant/planar_gap.h"

/// Distances between the bodies of the rig as the Bullet library sees them, in three dimensions: links are
/// horizontal capsules, the platform is a sphere, the pylon is an upright capsule.
namespace flinch::test {

static_assert(sizeof(btScalar) == sizeof(double));

class BulletGap {
 public:
  /// Gap of two capsules; negative where they penetrate. A capsule of no length is a sphere.
  double operator()(const PlanarCapsule& a, const PlanarCapsule& b) {
    btCapsuleShape shape_a(a.radius, length(a));
    btCapsuleShape shape_b(b.radius, length(b));
    return gap(shape_a, pose(a), shape_b, pose(b));
  }

  /// Gap of a capsule and an upright post.
  double to_post(const PlanarCapsule& capsule, const Disc& post) {
    btCapsuleShape shape(capsule.radius, length(capsule));
    btCapsuleShapeZ upright(post.radius, 2.0);
    btTransform at = btTransform::getIdentity();
    at.setOrigin({post.centre.x(), post.centre.y(), 0.0});
    return gap(shape, pose(capsule), upright, at);
  }

 private:
  struct Nearest : btCollisionWorld::ContactResultCallback {
    double gap = std::numeric_limits<double>::infinity();
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
      gap = std::min(gap, point.getDistance());
      return 0.0;
    }
  };

  static double length(const PlanarCapsule& capsule) { return (capsule.end - capsule.begin).norm(); }

  static btTransform pose(const PlanarCapsule& capsule) {
    const Eigen::Vector2d axis = capsule.end - capsule.begin;
    const Eigen::Vector2d centre = 0.5 * (capsule.begin + capsule.end);
    btTransform at;
    at.setRotation(btQuaternion(btVector3(0.0, 0.0, 1.0), std::atan2(-axis.x(), axis.y())));
    at.setOrigin({centre.x(), centre.y(), 0.0});
    return at;
  }

  double gap(btCollisionShape& shape_a, const btTransform& pose_a, btCollisionShape& shape_b,
             const btTransform& pose_b) {
    btCollisionObject a;
    btCollisionObject b;
    a.setCollisionShape(&shape_a);
    b.setCollisionShape(&shape_b);
    a.setWorldTransform(pose_a);
    b.setWorldTransform(pose_b);
    Nearest nearest;
    nearest.m_closestDistanceThreshold = 10.0;
    world_.contactPairTest(&a, &b, nearest);
    return nearest.gap;
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
};

}  // namespace flinch::test
