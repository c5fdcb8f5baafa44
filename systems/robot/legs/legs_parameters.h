#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "systems/robot/body.h"
#include "systems/robot/body_dynamics.h"
#include "systems/robot/joint_friction.h"
#include "systems/robot/legs/platform_moves.h"

namespace flinch {

/// A universal joint turns about two axes, a spherical one about x, y and z of its frame, one after the
/// other; a screw turns and slides along its axis.
enum class LegJointKind { revolute, prismatic, universal, spherical, screw };

/// Number of axes about or along which such a joint moves independently: 1, 2 or 3.
int axis_count(LegJointKind kind);
/// Whether its position is a length.
bool slides(LegJointKind kind);

/// The drive of a joint of one axis. Drive position = ratio q + zero.
struct LegDrive {
  double armature = 0.0;  ///< Rotor as felt at the joint [kg m^2 or kg].
  double ratio = 1.0;
  double zero = 0.0;  ///< [rad or m]
};

/// A joint that a belt, gear or parallel rod makes move as another: q = ratio q_joint + offset.
struct LegFollowing {
  std::string joint;
  double ratio = 1.0;
  double offset = 0.0;  ///< [rad or m]
};

/// What moves with a joint, in the frame of the joint as it has moved.
struct LegLink {
  RigidBodyInertia inertia;
  std::vector<Shape> shapes;
};

/// A joint of a leg. Its frame at zero stands at `at`, turned by the rotation vector `turned`, in the link
/// that carries it.
struct LegJoint {
  std::string name;
  /// Joint whose link carries it, or "base"; empty: the joint before, the base for the first.
  std::string on;
  LegJointKind kind = LegJointKind::revolute;
  Eigen::Vector3d at{0.0, 0.0, 0.0};           ///< [m]
  Eigen::Vector3d turned{0.0, 0.0, 0.0};       ///< [rad]
  Eigen::Vector3d axis{0.0, 0.0, 1.0};         ///< In the joint's frame, of any length.
  Eigen::Vector3d second_axis{0.0, 1.0, 0.0};  ///< Of a universal joint.
  double pitch = 0.0;                          ///< Way of a screw in one turn [m].
  std::optional<LegDrive> drive;
  std::optional<LegFollowing> follows;
  bool measured = false;                                    ///< A passive joint with an encoder.
  std::array<double, 3> reference{};                        ///< Where each axis is about at home [rad or m].
  double least = -std::numeric_limits<double>::infinity();  ///< Of a joint of one axis [rad or m].
  double most = std::numeric_limits<double>::infinity();
  JointFriction friction;  ///< About or along each of its axes.
  std::optional<LegLink> link;
};

/// A point or frame of a leg's link that coincides with one of the platform, the base or another of its
/// links.
struct LegClosure {
  enum class On { platform, base, joint };

  std::string joint;                      ///< Whose link it is; empty: the last.
  Eigen::Vector3d at{0.0, 0.0, 0.0};      ///< In that link [m].
  Eigen::Vector3d turned{0.0, 0.0, 0.0};  ///< [rad]
  On on = On::platform;
  std::string on_joint;
  Eigen::Vector3d on_at{0.0, 0.0, 0.0};      ///< In the platform, the base frame, or the other link [m].
  Eigen::Vector3d on_turned{0.0, 0.0, 0.0};  ///< [rad]
  bool holds_frame = false;                  ///< Otherwise a point.
};

/// A tree of joints that stands on the base.
struct RobotLeg {
  Eigen::Vector3d at{0.0, 0.0, 0.0};      ///< Frame of the leg in the base frame [m].
  Eigen::Vector3d turned{0.0, 0.0, 0.0};  ///< [rad]
  std::vector<LegJoint> joints;
  std::vector<LegClosure> closures;
};

/// A drive that moves with several joints: its position is the sum of weight times joint position. A joint is
/// named "leg1.shoulder".
using DriveSum = std::vector<std::pair<std::string, double>>;

/// Everything about a parallel robot of base, legs and platform.
struct LegsParameters {
  std::string name = "robot";
  PlatformMoves moves;
  Eigen::Vector3d home_position{0.0, 0.0, 0.0};  ///< Of the origin of E [m].
  Eigen::Vector3d home_rotation{0.0, 0.0, 0.0};  ///< Rotation vector of E [rad].
  /// That makes an angle comparable to a distance [m].
  double characteristic_length = 0.0;
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< In the base frame [m/s^2].
  LegLink platform;
  std::optional<RigidBodyInertia> payload;  ///< Fixed to the platform, in its frame.
  std::vector<RobotLeg> legs;
  std::vector<DriveSum> drive_map;  ///< In the place of the joints' drives; empty: each of these is one.
};

/// All that is wrong with the description of `parameters`, each as one sentence that begins with the field,
/// "legs[0].joints[1].axis has no length". Whether such a robot can be assembled, legs_model() says.
std::vector<std::string> description_problems(const LegsParameters& parameters);

/// Joints of `leg` whose links can be touched: two, or as many as there are.
std::vector<std::size_t> bodies_of(const RobotLeg& leg);

/// Index of the joint of that name in `leg`; nothing where there is none.
std::optional<std::size_t> joint_index(const RobotLeg& leg, const std::string& name);

}  // namespace flinch
