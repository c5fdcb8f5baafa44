#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

namespace flinch {

/// Outlines of bodies, in the frame of the body [m]. A planar body lies in the plane z = 0 of its frame.
struct Sphere {
  Eigen::Vector3d centre{0.0, 0.0, 0.0};
  double radius = 0.0;
};

/// All points within `radius` of a segment.
struct Capsule {
  Eigen::Vector3d begin{0.0, 0.0, 0.0};
  Eigen::Vector3d end{0.0, 0.0, 0.0};
  double radius = 0.0;
};

/// A box whose edges are parallel to the axes of its own frame.
struct Box {
  Eigen::Vector3d centre{0.0, 0.0, 0.0};
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< Columns: the box's axes.
  Eigen::Vector3d half_lengths{0.0, 0.0, 0.0};
};

/// The convex hull of points, grown by `margin` to all sides.
struct ConvexHull {
  std::vector<Eigen::Vector3d> points;
  double margin = 0.0;
};

using Shape = std::variant<Sphere, Capsule, Box, ConvexHull>;

/// One rigid body of a mechanism. Its frame: the platform's is E; that of a link has its origin on the
/// proximal joint, and the mechanism says which of its axes points along the link.
struct Body {
  std::string name;  ///< "platform", "leg1_link1": unique in its mechanism.
  int leg = -1;      ///< To which leg it belongs, from 0; -1: to none.
  std::vector<Shape> shapes;
};

/// Two bodies of a mechanism that may run into one another, by their indices.
struct BodyPair {
  int a = 0;
  int b = 0;
};

/// A link that may run into the platform, with that part of its outline which may.
struct BesidePlatform {
  int body = 0;  ///< Its index.
  Shape shape;   ///< In the frame of the link.
};

/// All pairs of bodies that belong to different legs.
std::vector<BodyPair> pairs_of_different_legs(const std::vector<Body>& bodies);

}  // namespace flinch
