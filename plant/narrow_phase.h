#pragma once

#include <Eigen/Core>
#include <memory>

#include "plant/contact_forces.h"
#include "systems/robot/body.h"

namespace flinch {

/// Where the frame of a body is: origin and axes (columns) in the base frame.
struct Placement {
  Eigen::Vector3d origin{0.0, 0.0, 0.0};
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

/// A box whose sides are parallel to the axes of the base frame [m].
struct AxisBox {
  Eigen::Vector3d low{0.0, 0.0, 0.0};
  Eigen::Vector3d high{0.0, 0.0, 0.0};

  /// Whether the boxes come within `reach` of one another along every axis.
  bool is_near(const AxisBox& other, double reach) const {
    return ((low - other.high).array() <= reach).all() && ((other.low - high).array() <= reach).all();
  }
};

/// A convex shape in space, for distances by the Bullet library in double precision. Immutable.
class Solid {
 public:
  explicit Solid(const Shape& shape);
  ~Solid();
  Solid(Solid&&) noexcept;
  Solid& operator=(Solid&&) noexcept;

  /// The box around it. Never allocates.
  AxisBox box(const Placement& at) const noexcept;

  /// Where `a` and `b` are nearest: normal from a towards b. Distances of spheres and capsules are exact to
  /// rounding, those of hulls and boxes to 1e-12 m, and where they overlap by more than 20 mm to some
  /// millimetres; a box has no rounded edges. Infinite where the search finds nothing. Never allocates; keeps
  /// nothing from call to call.
  friend SurfaceGap nearest(const Solid& a, const Placement& at_a, const Solid& b,
                            const Placement& at_b) noexcept;

 private:
  struct Convex;
  std::unique_ptr<const Convex> convex_;
};

}  // namespace flinch
