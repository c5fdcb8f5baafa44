#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "systems/robot/body.h"
#include "systems/robot/body_dynamics.h"
#include "systems/robot/joint_friction.h"

namespace flinch {

/// A link of a model.
struct GraphBody {
  std::string name;
  RigidBodyInertia inertia;   ///< In the frame of the body.
  std::vector<Shape> shapes;  ///< In it.
  bool has_mesh = false;      ///< Of which nothing is read.
};

/// A joint of a model moves as another: q = ratio q_joint + offset.
struct GraphFollowing {
  std::string joint;
  double ratio = 1.0;
  double offset = 0.0;  ///< [rad or m]
};

/// What holds two bodies together. Frame of the parent's side times motion = frame of the child's side. A
/// pair of frames that coincide is one of a kind that does not move, a pair of points a spherical one.
struct GraphJoint {
  enum class Kind { fixed, revolute, prismatic, screw, spherical };

  std::string name;
  Kind kind = Kind::fixed;
  std::size_t parent = 0, child = 0;
  Eigen::Isometry3d in_parent = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d in_child = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis{0.0, 0.0, 1.0};  ///< In that frame, of unit length.
  double lead = 0.0;                    ///< Of a screw [m/rad].
  double zero = 0.0;  ///< What the model calls its position where it does not move [rad or m].
  double least = -std::numeric_limits<double>::infinity();  ///< Of its position, as the model calls it.
  double most = std::numeric_limits<double>::infinity();
  double armature = 0.0;
  JointFriction friction;
  std::optional<GraphFollowing> follows;
  bool driven = false;
  double effort = 0.0;  ///< Largest [Nm or N]; 0: the model says nothing.
  bool closes = false;  ///< Closes a loop of a model that is a tree otherwise.

  bool turns() const { return kind == Kind::revolute || kind == Kind::screw; }
};

/// A frame of a model that has a name.
struct GraphFrame {
  std::string name;
  std::size_t body = 0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< In that body.
};

/// Links and joints of a model, in whichever format it came.
struct BodyGraph {
  std::string name = "robot";
  std::string file;
  std::vector<GraphBody> bodies;
  std::vector<GraphJoint> joints;
  std::vector<GraphFrame> frames;  ///< Those of the links among them.
  std::size_t base = 0;
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< In the frame of the base [m/s^2].
  std::map<std::string, double> zeros;       ///< About where joints are at home [rad or m].
  std::vector<std::string> notes;            ///< What was left out, one sentence each.

  /// Adds a body and its frame; throws SetupError where the name is taken.
  std::size_t add_body(GraphBody body);
  void add_frame(GraphFrame frame);
  /// Throw SetupError naming the nearest that there is.
  const GraphFrame& frame(const std::string& frame_name) const;
  std::size_t joint(const std::string& joint_name) const;
  /// Takes `joints`, each driven, for all that are.
  void set_driven(const std::vector<std::string>& driven);

  [[noreturn]] void refuse(const std::string& complaint) const;
};

/// The graph without joints that do not move: bodies that they hold together are one. What follows a joint
/// with a fixed partner is fixed too. A body between two hinges about one line turns about it as it likes: it
/// is held on its neighbour other than `platform`, and told in the notes. Throws SetupError where a loop of
/// such joints does not fit.
BodyGraph without_fixed_joints(BodyGraph graph, const std::string& platform);

/// Inertia, shapes and the like of `body`, whose frame stands at `pose` in another one, in that one.
RigidBodyInertia placed_at(const Eigen::Isometry3d& pose, const RigidBodyInertia& body);
Shape placed_at(const Eigen::Isometry3d& pose, const Shape& shape);

}  // namespace flinch
