#pragma once

#include <array>
#include <memory>

#include "plant/bench_shapes.h"

namespace flinch {

/// Boxes around the bodies of the bench, from the Bullet library in double precision. Boxes that do not
/// overlap hold bodies that do not touch. Immutable: one object serves many threads.
class BroadPhase {
 public:
  /// The links' lengths are those of `home`, which must be reachable.
  BroadPhase(const BenchShapes& shapes, const PlanarMotion& home);
  ~BroadPhase();

  /// A box whose sides are parallel to the axes of the base frame [m].
  struct Box {
    Eigen::Vector2d low{0.0, 0.0};
    Eigen::Vector2d high{0.0, 0.0};

    /// Whether the boxes, each grown to all sides by half of `reach`, overlap.
    bool overlaps(const Box& other, double reach) const {
      return ((low - other.high).array() <= reach).all() && ((other.low - high).array() <= reach).all();
    }
  };

  static constexpr std::size_t pylon = 7;  ///< Index of the pylon's box; robot bodies are at BodyId::index().
  using Boxes = std::array<Box, 8>;

  /// The boxes of a reachable motion. Never allocates.
  Boxes boxes(const PlanarMotion& motion, const PylonMotion& pylon) const noexcept;

 private:
  struct Shapes;
  std::unique_ptr<const Shapes> shapes_;
};

}  // namespace flinch
