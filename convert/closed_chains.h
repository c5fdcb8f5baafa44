#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "convert/body_graph.h"

namespace flinch {

/// A joint of a chain. The frames of all links are parallel to the base frame where no joint has moved, and
/// stand on their joints.
struct ChainLink {
  std::size_t joint = 0;  ///< Of the graph.
  std::string name;
  GraphJoint::Kind kind = GraphJoint::Kind::revolute;
  int parent = -1;  ///< Link that carries it; -1: the base.
  int body = -1;    ///< Of the graph, what moves with it; -1: nothing, as with a hinge at a closure.
  Eigen::Vector3d origin{0.0, 0.0, 0.0};  ///< Where nothing has moved, in the base frame [m].
  Eigen::Vector3d axis{0.0, 0.0, 1.0};    ///< In the base frame.
  double lead = 0.0;                      ///< [m/rad]
  int coordinate = 0;
  double ratio = 1.0, offset = 0.0;  ///< Position = ratio s + offset.
  int follows = -1;                  ///< Link whose position it follows.

  bool slides() const { return kind == GraphJoint::Kind::prismatic; }
};

/// A frame or point of a link that coincides with one of the platform, the base or another link.
struct ChainJoin {
  enum class On { platform, base, link };

  std::size_t link = 0;
  Eigen::Isometry3d at = Eigen::Isometry3d::Identity();  ///< In the frame of the link.
  On on = On::platform;
  std::size_t on_link = 0;
  /// In the frame of E, of the base, or of the other link.
  Eigen::Isometry3d on_at = Eigen::Isometry3d::Identity();
  bool holds_frame = false;
};

/// A leg as a model has it.
struct ChainLeg {
  std::vector<ChainLink> links;
  std::vector<ChainJoin> joins;
  int coordinates = 0;
};

/// How the chains of a model stand in the frame that flinch calls the base.
struct ChainSettings {
  std::string platform;  ///< The frame E.
  /// Axes of the base frame, as columns in those of the model's base.
  Eigen::Matrix3d base_axes = Eigen::Matrix3d::Identity();
  /// Everything moves in the plane z = 0 of the base frame, and heights do not count.
  bool planar = false;
};

/// The robot as legs that stand on the base and close on the platform.
struct ClosedChains {
  std::vector<ChainLeg> legs;
  std::vector<Eigen::Isometry3d> bodies;  ///< Of the graph, where no joint has moved: base frame.
  Eigen::Isometry3d platform = Eigen::Isometry3d::Identity();       ///< E there, in the base frame.
  Eigen::Isometry3d frame_in_body = Eigen::Isometry3d::Identity();  ///< E in the platform's body.
  std::size_t platform_body = 0;
  bool planar = false;

  /// Of all legs.
  int coordinates() const;
};

/// Takes base and platform out of the graph: each connected rest is a leg, a tree from the base whose other
/// joints close loops. A hinge at a closure is a joint that carries nothing, a ball joint a point. Throws
/// SetupError with the link or joint that makes no such robot.
ClosedChains closed_chains(const BodyGraph& graph, const ChainSettings& settings);

}  // namespace flinch
