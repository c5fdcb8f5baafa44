#include "systems/robot/imu_mount.h"

#include <gtest/gtest.h>

#include <numbers>

namespace flinch {
namespace {

// Turned by 90 degrees about x, the platform's z axis is the sensor's y axis; then about y, and so on.
TEST(ImuMount, TurnsAboutXThenYThenZ) {
  constexpr double right = std::numbers::pi / 2.0;
  const Eigen::Vector3d x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), z(0.0, 0.0, 1.0);
  EXPECT_LT((platform_to_sensor({{0.0, 0.0, 0.0}, {right, 0.0, 0.0}}) * z - y).norm(), 1e-15);
  // About x, then about the turned y, which is the platform's z: the sensor's z axis is the platform's x axis
  // ...
  const Eigen::Matrix3d both = platform_to_sensor({{0.0, 0.0, 0.0}, {right, right, 0.0}});
  EXPECT_LT((both * x - z).norm(), 1e-15);
  EXPECT_LT((both * z - y).norm(), 1e-15);  // ... and its y axis is the platform's z axis
}

}  // namespace
}  // namespace flinch
