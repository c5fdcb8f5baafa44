#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace flinch::test {

/// A platform motion known in closed form: in each coordinate a sine as fast as the rig is driven, up
/// to 1.5 m/s, 19 m/s^2 and 240 m/s^3.
struct SmoothTrajectory {
  Eigen::Vector3d pose;
  Eigen::Vector3d velocity;
  Eigen::Vector3d acceleration;

  explicit SmoothTrajectory(double t) {
    constexpr double pi = std::numbers::pi;
    const Eigen::Array3d amplitude(0.12, 0.10, 0.15);
    const Eigen::Array3d rate = 2.0 * pi * Eigen::Array3d(2.0, 1.5, 1.2);
    const Eigen::Array3d angle = rate * t + Eigen::Array3d(0.3, 1.1, 2.0);
    pose = amplitude * angle.sin();
    velocity = amplitude * rate * angle.cos();
    acceleration = -amplitude * rate.square() * angle.sin();
  }
};

}  // namespace flinch::test
