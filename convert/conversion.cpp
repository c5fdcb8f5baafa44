#include "convert/conversion.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "convert/home_search.h"
#include "convert/leg_parameters.h"
#include "convert/mjcf_model.h"
#include "convert/platform_motion.h"
#include "convert/sdf_model.h"
#include "convert/urdf_model.h"
#include "convert/xml_tree.h"
#include "systems/config/legs_text.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/drive_parameters.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/legs/legs_robot.h"

namespace flinch {
namespace {

constexpr double cad_noise =
    1e-5;  // by which loops may stay open out of the plane, or as programs write them [m]
constexpr double rounding = 1e-10;    // to which loops close [m]
constexpr int most_coordinates = 60;  // of a model, base and platform set apart
constexpr int nearby_states = 8;
constexpr double heavy = 1e4;         // [kg]
constexpr double much_heavier = 1e3;  // than another link

std::vector<std::string> driven_names(const BodyGraph& graph) {
  std::vector<std::string> names;
  for (const GraphJoint& joint : graph.joints) {
    if (joint.driven) names.push_back(joint.name);
  }
  return names;
}

/// A number of two digits.
double rounded(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::round(value / unit) * unit;
}

std::string short_number(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

class Converting {
 public:
  Converting(BodyGraph graph, const ConversionSettings& settings) : settings_(settings) {
    result_.graph = std::move(graph);
  }

  Conversion convert() {
    apply_settings();
    ChainState home = find_moving_home();
    lay_into_plane(home);
    const double length = rounded(characteristic_length(result_.chains));
    const MotionSamples samples =
        motion_samples(result_.chains, result_.home, length, nearby_states, rounding);
    const PlatformMoves moves = platform_moves(result_.graph, result_.chains, samples);
    check_drives(moves);
    result_.robot = leg_parameters(result_.graph, result_.chains, result_.home, moves, notes_);
    result_.robot.characteristic_length = length;
    check_robot();
    tell_masses();
    result_.notes = result_.graph.notes;
    result_.notes.insert(result_.notes.end(), notes_.begin(), notes_.end());
    return std::move(result_);
  }

 private:
  BodyGraph& graph() { return result_.graph; }

  void apply_settings() {
    if (!settings_.drives.empty()) graph().set_driven(settings_.drives);
    for (const std::string& link : settings_.massless)
      graph().bodies[graph().frame(link).body].inertia = RigidBodyInertia{};
    graph().frame(settings_.platform);
    for (const auto& [joint, value] : settings_.guess) graph().joint(joint);
    require_loops();
    if (driven_names(graph()).empty()) {
      std::vector<std::string> joints;
      for (const GraphJoint& joint : graph().joints) {
        if (joint.kind != GraphJoint::Kind::fixed && joint.kind != GraphJoint::Kind::spherical)
          joints.push_back(joint.name);
      }
      graph().refuse(
          "says of no joint that it is driven; name those that are by --drives JOINT,JOINT,..., of " +
          listed(joints));
    }
  }

  // A tree has a joint less than bodies.
  void require_loops() {
    const std::size_t bodies = graph().bodies.size();
    if (graph().joints.size() + 1 > bodies) return;
    graph().refuse(
        "closes no loop: it has " + std::to_string(bodies) + " links and " +
        std::to_string(graph().joints.size()) +
        " joints, as a serial arm has; a parallel robot is meant. Where frames that coincide are listed "
        "in a file of their own, name it by --closures FILE");
  }

  // Fixes joints that closed loops hold, until all that are left move.
  ChainState find_moving_home() {
    while (true) {
      graph() = without_fixed_joints(std::move(graph()), settings_.platform);
      result_.chains = closed_chains(graph(), {.platform = settings_.platform});
      check_size();
      const double length = characteristic_length(result_.chains);
      std::map<std::string, double> guess = settings_.guess;
      for (const GraphJoint& joint : graph().joints) {  // where nobody says otherwise
        const auto zero = graph().zeros.find(joint.name);
        if (zero != graph().zeros.end()) guess.insert(*zero);
      }
      const FoundHome home = find_home(graph(), result_.chains, guess, length, cad_noise);
      const MotionSamples samples =
          motion_samples(result_.chains, home.state, length, nearby_states, cad_noise);
      if (samples.motions.front().cols() == 0)
        graph().refuse(
            "cannot move: its closures hold every joint; check their frames, and whether each is meant "
            "to hold a frame (6d) or a point (3d)");
      if (!fix(frozen_joints(result_.chains, samples), home.state)) return remember(home);
    }
  }

  ChainState remember(const FoundHome& home) {
    if (home.searched) {
      notes_.push_back(
          "the zero of the model is singular, or beside a singularity: home is another place, found by "
          "itself; "
          "--guess JOINT=DEGREES says what is meant");
    }
    return home.state;
  }

  bool fix(const std::vector<std::size_t>& frozen, const ChainState& home) {
    bool any = false;
    for (std::size_t i = 0; i < result_.chains.legs.size(); ++i) {
      for (const ChainLink& link : result_.chains.legs[i].links) {
        if (std::find(frozen.begin(), frozen.end(), link.joint) == frozen.end()) continue;
        GraphJoint& joint = graph().joints[link.joint];
        if (joint.kind == GraphJoint::Kind::spherical || joint.kind == GraphJoint::Kind::fixed) continue;
        if (joint.driven)
          graph().refuse("the drive of joint '" + joint.name + "' cannot move: the closures hold it");
        const double q = home.s[i][link.coordinate];
        Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
        if (joint.turns()) motion.linear() = Eigen::AngleAxisd(q, joint.axis).toRotationMatrix();
        motion.translation() = (joint.turns() ? joint.lead * q : q) * joint.axis;
        joint.in_parent = joint.in_parent * motion;
        joint.kind = GraphJoint::Kind::fixed;
        notes_.push_back("joint '" + joint.name + "' never moves, as the closures hold it: it is fixed");
        any = true;
      }
    }
    return any;
  }

  void check_size() {
    if (result_.chains.coordinates() <= most_coordinates) return;
    graph().refuse("has " + std::to_string(result_.chains.coordinates()) + " joint coordinates; at most " +
                   std::to_string(most_coordinates) + " are looked at");
  }

  // Where all moves in a plane its third axis is the base frame's, and the model's z points up in it.
  void lay_into_plane(const ChainState& home) {
    result_.base_axes.setIdentity();
    const ClosedChains spatial = result_.chains;
    const auto normal = plane_normal(spatial, home);
    if (normal) {
      Eigen::Vector3d z = *normal;
      Eigen::Index largest = 0;
      z.cwiseAbs().maxCoeff(&largest);
      if (z[largest] < 0.0) z = -z;
      for (double& entry : z) {  // of an axis of the model what rounding has left of it
        if (std::abs(entry) < 1e-9) entry = 0.0;
      }
      z.normalize();
      const Eigen::Vector3d up = Eigen::Vector3d::UnitZ() - z.z() * z;
      const Eigen::Vector3d y = up.norm() > 1e-3
                                    ? up.normalized()
                                    : Eigen::Vector3d(Eigen::Vector3d::UnitY() - z.y() * z).normalized();
      result_.base_axes << y.cross(z), y, z;
      result_.chains = closed_chains(
          graph(), {.platform = settings_.platform, .base_axes = result_.base_axes, .planar = true});
    }
    const auto found = closed(result_.chains, same_state(spatial, home, result_.chains), rounding);
    if (!found) {
      const ClosureRows rows = closure_rows(result_.chains, same_state(spatial, home, result_.chains));
      graph().refuse("the loops do not close to rounding, but stay open by " +
                     short_number(1e3 * rows.e.lpNorm<Eigen::Infinity>()) +
                     " mm: the frames of closures contradict one another");
    }
    result_.home = *found;
  }

  void check_drives(const PlatformMoves& moves) {
    const std::vector<std::string> names = driven_names(graph());
    const auto n = static_cast<std::size_t>(moves.space.dimension());
    for (const std::string& name : settings_.drives.empty() ? names : settings_.drives) {
      if (std::find(names.begin(), names.end(), name) == names.end())
        graph().refuse("the drive of joint '" + name + "' moves nothing: it is part of a rigid body");
    }
    if (names.size() >= n) return;
    graph().refuse(
        "has " + std::to_string(names.size()) + " drives, " + listed(names) + ", for " + std::to_string(n) +
        " coordinates of the platform: it is underactuated, which flinch cannot control; name more by "
        "--drives JOINT,JOINT,...");
  }

  void check_robot() {
    std::vector<std::string> found = problems(result_.robot);
    for (std::string& problem : found)
      problem = graph().file + ": as a robot file, " + problem + origin_of(problem);
    throw_if_any(std::move(found));
    set_effort();
  }

  // Which joints of the model "legs[1]" is.
  std::string origin_of(const std::string& problem) const {
    if (!problem.starts_with("legs[")) return "";
    const std::size_t leg = static_cast<std::size_t>(problem[5] - '0');
    if (leg >= result_.robot.legs.size()) return "";
    std::vector<std::string> names;
    for (const LegJoint& joint : result_.robot.legs[leg].joints) names.push_back(joint.name);
    if (names.size() > 12) names.resize(12);
    return " (its joints: " + listed(names) + ")";
  }

  // What the model allows, if that holds the robot at home; otherwise five times what does, if that is much.
  void set_effort() {
    const LegsRobot robot(result_.robot);
    Kinematics kinematics;
    Dynamics dynamics;
    const Configuration home = robot.description().home_pose;
    robot.kinematics(home, PlatformVector::Zero(robot.dof()), robot.home_working_mode(), kinematics);
    robot.dynamics(kinematics, dynamics);
    if (!dynamics.valid) return;
    const Eigen::VectorXd held = kinematics.J_x_qa.transpose() * dynamics.g_x;
    const double needed = held.lpNorm<Eigen::Infinity>();
    double allowed = std::numeric_limits<double>::infinity();
    for (const GraphJoint& joint : graph().joints) {
      if (joint.driven) allowed = std::min(allowed, joint.effort);
    }
    const double usual = default_drives(robot.drive_kind(0), robot.drives()).max_torque;
    const std::string unit = robot.drive_kind(0) == DriveKind::revolute ? " Nm" : " N";
    if (allowed > 1.5 * needed) {
      result_.max_effort = std::min(allowed, 1e6 * usual);
    } else if (needed > 0.5 * usual) {
      result_.max_effort = rounded(5.0 * needed);
    }
    if (allowed > 0.0 && allowed <= 1.5 * needed) {
      notes_.push_back("the model allows drives " + short_number(allowed) + unit + ", and the robot needs " +
                       short_number(needed) + unit + " to stand at home: " +
                       short_number(result_.max_effort > 0.0 ? result_.max_effort : usual) + unit +
                       " is taken; change it in the file");
    }
  }

  void tell_masses() {
    double least = std::numeric_limits<double>::infinity();
    for (const GraphBody& body : graph().bodies) {
      if (body.inertia.mass > 0.0) least = std::min(least, body.inertia.mass);
    }
    for (std::size_t i = 0; i < graph().bodies.size(); ++i) {
      const GraphBody& body = graph().bodies[i];
      if (i == graph().base || (body.inertia.mass < heavy && body.inertia.mass < much_heavier * least))
        continue;
      notes_.push_back(
          "link '" + body.name + "', with what is fixed to it, weighs " + short_number(body.inertia.mass) +
          " kg, the lightest " + short_number(least) +
          " kg; links that are markers and have no mass in truth may be named by --massless LINK,LINK,...");
    }
  }

  const ConversionSettings& settings_;
  Conversion result_;
  std::vector<std::string> notes_;
};

std::string drives_text(const Conversion& conversion) {
  if (conversion.max_effort == 0.0) return "";
  bool sliding = false;
  for (const RobotLeg& leg : conversion.robot.legs) {
    for (const LegJoint& joint : leg.joints) sliding = sliding || (joint.drive && slides(joint.kind));
  }
  const DriveParameters usual = default_drives(sliding ? DriveKind::prismatic : DriveKind::revolute, 1);
  const double share = conversion.max_effort / usual.max_torque;
  const std::string name = sliding ? "force" : "torque";
  const std::string unit = sliding ? "N" : "Nm";
  return "drives:\n  max_" + name + "_" + unit + ": " + yaml_number(conversion.max_effort) + "\n  max_" +
         name + "_rate_" + unit + "_per_s: " + yaml_number(share * usual.max_torque_rate) + "\n  max_" +
         name + "_jump_" + unit + ": " + yaml_number(share * usual.max_torque_jump) + "\n";
}

}  // namespace

BodyGraph read_model(std::string_view text, const std::string& file) {
  const XmlElement root = parse_xml(text, file);
  if (root.name == "robot") return read_urdf(root);
  if (root.name == "sdf") return read_sdf(root);
  if (root.name == "mujoco") return read_mjcf(root);
  root.refuse("is no description of a robot; URDF begins with <robot>, SDF with <sdf>, MJCF with <mujoco>");
}

Conversion converted_robot(BodyGraph graph, const ConversionSettings& settings) {
  return Converting(std::move(graph), settings).convert();
}

std::string robot_text(const Conversion& conversion) {
  std::string text = "# Converted by flinch convert from " + comment_text(conversion.graph.file) + ".\n";
  if (!conversion.base_axes.isIdentity(1e-12)) {
    text +=
        "# The robot moves in a plane, which is z = 0 here. Axes x, y and z of this file are, in the model's "
        "base:\n";
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d axis = conversion.base_axes.col(i);
      text += "#   [" + short_number(axis.x()) + ", " + short_number(axis.y()) + ", " +
              short_number(axis.z()) + "]\n";
    }
  }
  for (const std::string& note : conversion.notes) text += "# Note: " + comment_text(note) + ".\n";
  text += "# Frames of all links are parallel to the base frame where all joints are at zero.\n\n";
  text += legs_text(conversion.robot);
  const std::string drives = drives_text(conversion);
  if (!drives.empty()) text += "\n" + drives;
  return text + "\nworkspace_limits: {min_abs_det_A: 0.05, min_abs_det_B: 0.05}\n";
}

}  // namespace flinch
