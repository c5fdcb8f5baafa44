#include "convert/solids.h"

#include <Eigen/Geometry>
#include <numbers>

namespace flinch {
namespace {

RigidBodyInertia solid(double mass, const Eigen::Vector3d& moments) {
  RigidBodyInertia body;
  body.mass = mass;
  body.inertia.diagonal() = moments;
  return body;
}

}  // namespace

double sphere_volume(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }
double cylinder_volume(double radius, double length) { return std::numbers::pi * radius * radius * length; }

RigidBodyInertia solid_sphere(double mass, double radius) {
  return solid(mass, Eigen::Vector3d::Constant(0.4 * mass * radius * radius));
}

RigidBodyInertia solid_cylinder(double mass, double radius, double length) {
  const double across = mass * (3.0 * radius * radius + length * length) / 12.0;
  return solid(mass, {across, across, 0.5 * mass * radius * radius});
}

// Half a sphere has its centre 3 r / 8 from its base; about a line across it there it has 2 m r^2 / 5.
RigidBodyInertia solid_capsule(double mass, double radius, double length) {
  const double volume = sphere_volume(radius) + cylinder_volume(radius, length);
  const double caps = mass * sphere_volume(radius) / volume;
  RigidBodyInertia body = solid_cylinder(mass - caps, radius, length);
  const double across = caps * (0.4 * radius * radius + 0.25 * length * length + 0.375 * radius * length);
  body.inertia.diagonal() += Eigen::Vector3d(across, across, 0.4 * caps * radius * radius);
  body.mass = mass;
  return body;
}

RigidBodyInertia solid_box(double mass, const Eigen::Vector3d& half_lengths) {
  const Eigen::Vector3d squares = half_lengths.cwiseAbs2();
  return solid(mass, mass / 3.0 * (Eigen::Vector3d::Constant(squares.sum()) - squares));
}

Eigen::Matrix3d axes_with_z_along(const Eigen::Vector3d& direction) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), direction).toRotationMatrix();
}

}  // namespace flinch
