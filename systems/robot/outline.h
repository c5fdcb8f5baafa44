#pragma once

#include <Eigen/Core>
#include <vector>

#include "systems/robot/body.h"

namespace flinch {

/// Where a line is inside of a body: at points + s direction with enter <= s <= leave.
struct LinePassage {
  bool hits = false;
  double enter = 0.0;
  double leave = 0.0;
};

/// The outline of a body for lines that pass through it, in the frame of the body [m]. A hull with a margin
/// counts as one whose faces are moved out by it, with sharp edges. A planar body lies in the plane z = 0,
/// and so must the lines.
class Outline {
 public:
  explicit Outline(const std::vector<Shape>& shapes);

  /// From where the line enters the first to where it leaves the last of the shapes; `direction` is of unit
  /// length.
  LinePassage passage(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const noexcept;

  /// The outward normal at a point of the outline, of the face or the round part that it is nearest to; zero
  /// for a body without shapes.
  Eigen::Vector3d normal_at(const Eigen::Vector3d& point) const noexcept;

  /// The point of the outline that lies farthest in a direction; the origin of a body without shapes.
  Eigen::Vector3d farthest(const Eigen::Vector3d& direction) const noexcept;

 private:
  /// Points x with normal . x <= offset.
  struct HalfSpace {
    Eigen::Vector3d normal;
    double offset = 0.0;
  };
  struct Polytope {
    std::vector<HalfSpace> faces;
    std::vector<Eigen::Vector3d> corners;
    double margin = 0.0;
  };
  /// All points within `radius` of a segment, which has no length where it is a sphere.
  using Round = Capsule;

  void add(const Sphere& sphere);
  void add(const Capsule& capsule);
  void add(const Box& box);
  void add(const ConvexHull& hull);

  static LinePassage through(const Round& round, const Eigen::Vector3d& point,
                             const Eigen::Vector3d& direction);
  static LinePassage through(const Polytope& polytope, const Eigen::Vector3d& point,
                             const Eigen::Vector3d& direction);

  std::vector<Round> rounds_;
  std::vector<Polytope> polytopes_;
};

}  // namespace flinch
