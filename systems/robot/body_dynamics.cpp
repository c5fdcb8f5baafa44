#include "systems/robot/body_dynamics.h"

namespace flinch {
namespace {

// About a point at `offset` from the centre of mass.
Eigen::Matrix3d moved(const RigidBodyInertia& body, const Eigen::Vector3d& offset) {
  const Eigen::Matrix3d S = cross_matrix(offset);
  return body.inertia - body.mass * S * S;
}

}  // namespace

RigidBodyInertia scaled(const RigidBodyInertia& body, double factor) {
  return {factor * body.mass, body.centre_of_mass, factor * body.inertia};
}

Eigen::Matrix3d about_origin(const RigidBodyInertia& body) { return moved(body, body.centre_of_mass); }

RigidBodyInertia together(const RigidBodyInertia& a, const RigidBodyInertia& b) {
  const double mass = a.mass + b.mass;
  const Eigen::Vector3d centre = (a.mass * a.centre_of_mass + b.mass * b.centre_of_mass) / mass;
  return {.mass = mass,
          .centre_of_mass = centre,
          .inertia = moved(a, a.centre_of_mass - centre) + moved(b, b.centre_of_mass - centre)};
}

}  // namespace flinch
