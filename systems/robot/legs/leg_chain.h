#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "systems/robot/body_dynamics.h"
#include "systems/robot/joint_friction.h"

namespace flinch {

/// Largest number of joints of one axis in a leg, those that follow others included.
inline constexpr std::size_t max_leg_joints = 12;
/// Largest number of independent joint coordinates of a leg.
inline constexpr int max_leg_coordinates = 8;

/// s: the independent joint coordinates of a leg [rad or m].
using LegCoordinates = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_leg_coordinates, 1>;

/// A joint of one axis in a leg, and what moves with it.
struct ChainJoint {
  int parent = -1;    ///< Joint whose link carries it; -1: the base.
  int described = 0;  ///< Joint of the description that it is an axis of.
  bool slides = false;
  int coordinate = 0;  ///< Of the leg: q = ratio s + offset.
  double ratio = 1.0;
  double offset = 0.0;
  Eigen::Vector3d at{0.0, 0.0, 0.0};          ///< In the link that carries it [m].
  Eigen::Vector3d axis{0.0, 0.0, 1.0};        ///< In the axes of that link, of unit length.
  Eigen::Matrix3d turn, turn_sin, turn_cos1;  ///< Axes: turn + sin q turn_sin + (1 - cos q) turn_cos1.
  double least = -std::numeric_limits<double>::infinity();  ///< Range of q [rad or m].
  double most = std::numeric_limits<double>::infinity();
  RigidBodyInertia link;  ///< No mass: none.
  double armature = 0.0;  ///< Rotor as felt at the joint [kg m^2 or kg].
  JointFriction friction;

  /// Sets the axis and how the frame turns about it, from the frame at zero and the axis in it.
  void set_axis(const Eigen::Matrix3d& frame, const Eigen::Vector3d& axis_in_frame);
  double position(const LegCoordinates& s) const noexcept { return ratio * s[coordinate] + offset; }
};

/// Where the joints of a leg are: base frame.
struct ChainPlace {
  std::array<Eigen::Vector3d, max_leg_joints> origin;  ///< Of the frame that moves with the joint [m].
  std::array<Eigen::Vector3d, max_leg_joints> axis;
  std::array<Eigen::Matrix3d, max_leg_joints> axes;  ///< R: from the frame that moves with the joint.
};

/// How they move.
struct ChainRates {
  std::array<Eigen::Vector3d, max_leg_joints> velocity;  ///< Of the origins [m/s].
  std::array<Eigen::Vector3d, max_leg_joints> omega;     ///< [rad/s]
  std::array<Eigen::Vector3d, max_leg_joints> axis_rate;
};

/// Columns of the maps from the rates of a leg's coordinates to the velocity of a point and to the angular
/// velocity of its link, and their time derivatives. One entry a coordinate.
struct PointColumns {
  using Columns = std::array<Eigen::Vector3d, static_cast<std::size_t>(max_leg_coordinates)>;
  Columns v, w, dv, dw;
};

/// A tree of joints that stands on the base.
struct LegChain {
  Eigen::Vector3d base{0.0, 0.0, 0.0};  ///< Frame of the leg, in the base frame [m].
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  std::vector<ChainJoint> joints;               ///< Each after the one that carries it.
  std::vector<std::vector<std::size_t>> paths;  ///< Of each joint: the joints from the base to it.
  int coordinates = 0;

  void place(const LegCoordinates& s, ChainPlace& out) const noexcept;
  void rates(const ChainPlace& place, const LegCoordinates& s_rate, ChainRates& out) const noexcept;

  /// Columns v and w of a point of the link of `joint` that is at `point` in the base frame.
  void columns(const ChainPlace& place, std::size_t joint, const Eigen::Vector3d& point,
               PointColumns& out) const noexcept;
  /// The time derivatives dv and dw as well; `point_rate` is the velocity of the point.
  void columns(const ChainPlace& place, const ChainRates& rates, std::size_t joint,
               const Eigen::Vector3d& point, const Eigen::Vector3d& point_rate,
               PointColumns& out) const noexcept;
};

}  // namespace flinch
