#include "tests/experiments/report/sample_robot.h"

#include <algorithm>
#include <cmath>

namespace flinch::sample {
namespace {

using Eigen::Vector2d;

constexpr double coupling_radius = 0.107;

Vector2d direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double segment_distance(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  double nearest = 1e9;
  for (int i = 0; i <= 20; ++i) {
    const Vector2d p = a + (b - a) * i / 20.0;
    const double t = std::clamp((p - c).dot(d - c) / (d - c).squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p - c - t * (d - c)).norm());
  }
  return nearest;
}

}  // namespace

Vector2d Leg::base_joint() const { return base * Vector2d(std::sin(angle), -std::cos(angle)); }

Vector2d Leg::coupling_in_platform() const { return coupling_radius * direction(coupling); }

Configuration configuration(const Eigen::Vector3d& pose) {
  Configuration result;
  Eigen::Matrix3d J_qa_x;
  for (int i = 0; i < 3; ++i) {
    const Leg& leg = legs[static_cast<size_t>(i)];
    const Vector2d arm = Eigen::Rotation2Dd(pose.z()) * leg.coupling_in_platform();
    const Vector2d coupling = pose.head<2>() + arm;
    const Vector2d reach = coupling - leg.base_joint();
    const double rho = reach.norm();
    const double cos_eta =
        (leg.proximal * leg.proximal + rho * rho - leg.distal * leg.distal) / (2.0 * leg.proximal * rho);
    const double theta1 = std::atan2(reach.y(), reach.x()) - std::acos(cos_eta);
    const Vector2d elbow = leg.base_joint() + leg.proximal * direction(theta1);
    const Vector2d e = (coupling - elbow) / leg.distal;
    const double s = cross(direction(theta1), e);
    J_qa_x.row(i) << e.x() / (leg.proximal * s), e.y() / (leg.proximal * s),
        cross(arm, e) / (leg.proximal * s);
    result.qa[i] = std::remainder(theta1 - leg.angle, 360.0 * degree);
    result.elbow[static_cast<size_t>(i)] = elbow;
    result.coupling[static_cast<size_t>(i)] = coupling;
  }
  result.J_x_qa = J_qa_x.inverse();
  return result;
}

double sigma_kappa(const Configuration& configuration) {
  const Eigen::Vector3d values = Eigen::JacobiSVD<Eigen::Matrix3d>(configuration.J_x_qa).singularValues();
  return values[0] / values[2];
}

double sigma_sc(const Configuration& configuration) {
  double nearest = 1e9;
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3;
    const Vector2d base_i = legs[i].base_joint(), base_j = legs[j].base_joint();
    const auto& elbow = configuration.elbow;
    const auto& coupling = configuration.coupling;
    nearest = std::min({nearest, segment_distance(elbow[i], coupling[i], elbow[j], coupling[j]),
                        segment_distance(elbow[i], coupling[i], base_j, elbow[j]),
                        segment_distance(base_i, elbow[i], elbow[j], coupling[j])});
  }
  return nearest;
}

}  // namespace flinch::sample
