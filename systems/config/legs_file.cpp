#include "systems/config/legs_file.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "systems/config/config_node.h"
#include "systems/config/robot_keys.h"
#include "systems/robot/legs/legs_robot.h"
#include "systems/robot/legs/platform_twist.h"
#include "systems/robot/workspace_limits.h"

namespace flinch {
namespace {

std::span<double> entries(Eigen::Vector3d& v) { return {v.data(), 3}; }

// ---------------------------------------------------------------- bodies

std::optional<Eigen::Vector3d> point_of(const ConfigNode& node) {
  if (node.kind != ConfigNode::Kind::list || node.items.size() != 3) return std::nullopt;
  Eigen::Vector3d point;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string& text = node.items[i]->scalar;
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), point[static_cast<Eigen::Index>(i)]);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  }
  return point.allFinite() ? std::optional(point) : std::nullopt;
}

ConvexHull read_hull(ConfigReader file) {
  ConvexHull hull;
  std::vector<std::shared_ptr<const ConfigNode>> points;
  file.required().nodes("points_m", points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto point = point_of(*points[i]);
    if (!point)
      file.problem("points_m", "has an entry " + std::to_string(i) + " that is no list of three numbers");
    hull.points.push_back(point.value_or(Eigen::Vector3d::Zero()));
  }
  file.number("margin", unit::m, hull.margin, not_negative);
  return hull;
}

Shape read_shape(ConfigReader file) {
  const std::string_view kind = file.one_of({"sphere", "capsule", "box", "hull"});
  if (kind == "capsule") {
    Capsule capsule;
    ConfigReader of = file.section("capsule");
    of.numbers("from", unit::m, entries(capsule.begin));
    of.required().numbers("to", unit::m, entries(capsule.end));
    of.required().number("radius", unit::m, capsule.radius, positive);
    return capsule;
  }
  if (kind == "box") {
    Box box;
    Eigen::Vector3d turned = Eigen::Vector3d::Zero();
    ConfigReader of = file.section("box");
    of.numbers("centre", unit::m, entries(box.centre));
    of.numbers("turned", unit::rad, entries(turned));
    of.required().numbers("half_lengths", unit::m, entries(box.half_lengths), positive);
    box.axes = rotation_exp(turned);
    return box;
  }
  if (kind == "hull") return read_hull(file.section("hull"));
  Sphere sphere;
  if (kind == "sphere") {
    ConfigReader of = file.section("sphere");
    of.numbers("centre", unit::m, entries(sphere.centre));
    of.required().number("radius", unit::m, sphere.radius, positive);
  }
  return sphere;
}

RigidBodyInertia read_inertia(ConfigReader& file) {
  RigidBodyInertia body;
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();
  Eigen::Vector3d products = Eigen::Vector3d::Zero();
  file.required().number("mass", unit::kg, body.mass);
  file.numbers("centre_of_mass", unit::m, entries(body.centre_of_mass));
  file.numbers("inertia", unit::kg_m2, entries(moments));
  file.numbers("inertia_products", unit::kg_m2, entries(products));
  const double xy = products[0];
  const double xz = products[1];
  const double yz = products[2];
  body.inertia << moments[0], xy, xz, xy, moments[1], yz, xz, yz, moments[2];
  return body;
}

LegLink read_link(ConfigReader file) {
  LegLink link{read_inertia(file), {}};
  for (const ConfigReader& shape : file.sections("shapes")) link.shapes.push_back(read_shape(shape));
  return link;
}

// ---------------------------------------------------------------- joints

/// Units of a joint that turns, or slides.
struct JointUnits {
  Unit position, armature;
};

JointUnits units_of(LegJointKind kind) {
  return slides(kind) ? JointUnits{unit::m, unit::kg} : JointUnits{unit::rad, unit::kg_m2};
}

LegDrive read_drive(ConfigReader file, const JointUnits& units) {
  LegDrive drive;
  file.number("armature", units.armature, drive.armature);
  file.number("ratio", unit::none, drive.ratio);
  file.number("zero", units.position, drive.zero);
  return drive;
}

LegFollowing read_following(ConfigReader file, const JointUnits& units) {
  LegFollowing following;
  file.required().text("joint", following.joint);
  file.number("ratio", unit::none, following.ratio);
  file.number("offset", units.position, following.offset);
  return following;
}

// A number is that of the first axis.
void read_reference(ConfigReader& file, const JointUnits& units, LegJoint& joint) {
  std::vector<double> values{0.0};
  file.one_or_numbers("reference", units.position, values, std::nullopt);
  if (values.size() > static_cast<std::size_t>(axis_count(joint.kind))) {
    return file.problem("reference", "has " + std::to_string(values.size()) + " entries; the joint has " +
                                         std::to_string(axis_count(joint.kind)) + " axes");
  }
  for (std::size_t i = 0; i < values.size(); ++i) joint.reference[i] = values[i];
}

LegJoint read_joint(ConfigReader file) {
  LegJoint joint;
  file.required().text("name", joint.name);
  file.text("on", joint.on);
  const bool known = file.required().choice("kind", joint.kind,
                                            {{"revolute", LegJointKind::revolute},
                                             {"prismatic", LegJointKind::prismatic},
                                             {"universal", LegJointKind::universal},
                                             {"spherical", LegJointKind::spherical},
                                             {"screw", LegJointKind::screw}});
  if (!known) {
    file.leave_rest_unread();
    return joint;
  }
  const JointUnits units = units_of(joint.kind);
  file.numbers("at", unit::m, entries(joint.at));
  file.numbers("turned", unit::rad, entries(joint.turned));
  if (joint.kind != LegJointKind::spherical) file.numbers("axis", unit::none, entries(joint.axis));
  if (joint.kind == LegJointKind::universal)
    file.required().numbers("second_axis", unit::none, entries(joint.second_axis));
  if (joint.kind == LegJointKind::screw) file.required().number("pitch", unit::m, joint.pitch);
  if (file.has("drive")) joint.drive = read_drive(file.section("drive"), units);
  if (file.has("follows")) joint.follows = read_following(file.section("follows"), units);
  file.flag("measured", joint.measured);
  read_reference(file, units, joint);
  if (axis_count(joint.kind) == 1) {
    std::array<double, 2> range{joint.least, joint.most};
    file.numbers("range", units.position, range);
    joint.least = range[0];
    joint.most = range[1];
  }
  if (file.has("friction")) {
    const ConfigReader friction = file.section("friction");
    joint.friction = slides(joint.kind) ? read_sliding_friction(friction) : read_friction(friction);
  }
  if (file.has("link")) joint.link = read_link(file.section("link"));
  return joint;
}

// ---------------------------------------------------------------- legs

bool has_any(const ConfigReader& file, std::string_view prefix) {
  for (const std::string_view key : file.keys()) {
    if (key.starts_with(prefix)) return true;
  }
  return false;
}

LegClosure read_closure(ConfigReader file) {
  LegClosure closure;
  file.text("joint", closure.joint);
  file.numbers("at", unit::m, entries(closure.at));
  file.choice("holds", closure.holds_frame, {{"point", false}, {"frame", true}});
  if (closure.holds_frame) {
    file.numbers("turned", unit::rad, entries(closure.turned));
    file.numbers("on_turned", unit::rad, entries(closure.on_turned));
  }
  const bool on_base = has_any(file, "on_base_");
  const bool on_joint = file.has("on_joint");
  const int said = (on_base ? 1 : 0) + (on_joint ? 1 : 0) + (has_any(file, "on_platform_") ? 1 : 0);
  if (said > 1) file.problem("", "closes on several bodies; give one of on_platform, on_base and on_joint");
  if (on_base) {
    closure.on = LegClosure::On::base;
    file.numbers("on_base", unit::m, entries(closure.on_at));
  } else if (on_joint) {
    closure.on = LegClosure::On::joint;
    file.text("on_joint", closure.on_joint);
    file.numbers("on", unit::m, entries(closure.on_at));
  } else {
    file.required().numbers("on_platform", unit::m, entries(closure.on_at));
  }
  return closure;
}

RobotLeg read_leg(ConfigReader file) {
  RobotLeg leg;
  file.numbers("at", unit::m, entries(leg.at));
  file.numbers("turned", unit::rad, entries(leg.turned));
  for (const ConfigReader& joint : file.required().sections("joints"))
    leg.joints.push_back(read_joint(joint));
  for (const ConfigReader& closure : file.required().sections("closures"))
    leg.closures.push_back(read_closure(closure));
  return leg;
}

// ---------------------------------------------------------------- the platform

PlatformMoves read_coordinates(ConfigReader& file) {
  std::array<ChartRole, 6> roles;
  roles.fill(ChartRole::fixed);
  ConfigReader section = file.required().section("coordinates");
  for (std::size_t i = 0; i < 6; ++i) {
    section.choice(chart_names[i], roles[i],
                   {{"fixed", ChartRole::fixed}, {"free", ChartRole::free}, {"follows", ChartRole::follows}});
  }
  const auto moves = moves_of(roles);
  if (!moves && file.good()) {
    file.problem("coordinates",
                 "frees coordinates that no robot can have yet; free are x, y, z, or all six, while "
                 "others follow or are fixed, or x and y, while rz follows");
  }
  return moves.value_or(PlatformMoves{});
}

PlatformMoves read_moves(ConfigReader& file) {
  std::vector<std::string> words = moves_words();
  words.emplace_back("coordinates");
  std::string word;
  file.required().word("moves", word, words);
  if (word == "coordinates") return read_coordinates(file);
  return moves_of(word);
}

void read_home(ConfigReader home, LegsParameters& robot) {
  home.number("x", unit::m, robot.home_position.x());
  home.number("y", unit::m, robot.home_position.y());
  if (robot.moves.planar) {
    home.number("phi", unit::rad, robot.home_rotation.z());
  } else {
    home.number("z", unit::m, robot.home_position.z());
    home.numbers("rotation", unit::rad, entries(robot.home_rotation));
  }
}

std::vector<DriveSum> read_drive_map(ConfigReader& file) {
  std::vector<DriveSum> map;
  for (ConfigReader& drive : file.sections("drive_map")) {
    DriveSum& sum = map.emplace_back();
    for (const std::string_view key : drive.keys()) {
      double weight = 1.0;
      drive.number(key, unit::none, weight);
      sum.emplace_back(key, weight);
    }
  }
  return map;
}

}  // namespace

LegsParameters read_legs_parameters(ConfigReader& file) {
  LegsParameters robot;
  file.text("name", robot.name);
  robot.moves = read_moves(file);
  read_home(file.required().section("home_pose"), robot);
  file.required().number("characteristic_length", unit::m, robot.characteristic_length, positive);
  file.numbers("gravity", unit::m_per_s2, entries(robot.gravity));
  robot.platform = read_link(file.required().section("platform"));
  if (file.has("payload")) {
    ConfigReader payload = file.section("payload");
    robot.payload = read_inertia(payload);
  }
  for (const ConfigReader& leg : file.required().sections("legs")) robot.legs.push_back(read_leg(leg));
  robot.drive_map = read_drive_map(file);
  return robot;
}

void begin_limits_of_legs(const ParallelRobot& robot, WorkspaceLimits& limits) {
  const LegsModel& model = dynamic_cast<const LegsRobot&>(robot).model();
  for (const ModelDrive& drive : model.drives) {
    if (drive.terms.size() != 1) continue;
    const ModelDrive::Term& term = drive.terms.front();
    const ChainJoint& joint = model.legs[term.leg].chain.joints[term.joint];
    const double ends[] = {drive.zero + term.weight * joint.least, drive.zero + term.weight * joint.most};
    limits.min_active = std::max(limits.min_active, std::min(ends[0], ends[1]));
    limits.max_active = std::min(limits.max_active, std::max(ends[0], ends[1]));
  }
}

std::shared_ptr<const ParallelRobot> read_legs(ConfigReader& file) {
  const LegsParameters robot = read_legs_parameters(file);
  if (!file.good()) return nullptr;
  note_problems(file, problems(robot), [](const std::string& field) { return field; });
  return file.good() ? std::make_shared<const LegsRobot>(robot) : nullptr;
}

}  // namespace flinch
