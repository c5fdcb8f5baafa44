#include "systems/config/legs_text.h"

#include <Eigen/Core>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "systems/config/config_node.h"
#include "systems/config/yaml_text.h"
#include "systems/robot/legs/legs_parameters.h"
#include "systems/robot/legs/platform_twist.h"

namespace flinch {
namespace {

constexpr double rounding = 1e-15;      // of 1 [m or 1]
constexpr double least_number = 1e-24;  // that files can say
constexpr double degrees = 180.0 / std::numbers::pi;

/// Keys and values between braces, or each on a line of its own.
class Mapping {
 public:
  explicit Mapping(std::string separator = ", ") : separator_(std::move(separator)) {}

  void add(const std::string& key, const std::string& value) {
    text_ += (text_.empty() ? "" : separator_) + key + ": " + value;
  }
  void add_word(const std::string& key, const std::string& word) { add(key, yaml_line(*scalar_node(word))); }
  void add(const std::string& key, double value) { add(key, yaml_number(value)); }
  void add(const std::string& key, std::span<const double> values, double unit = 1.0) {
    std::string list;
    for (const double value : values) list += (list.empty() ? "" : ", ") + yaml_number(value * unit);
    add(key, "[" + list + "]");
  }
  // What rounding leaves of 0 is 0.
  void add(const std::string& key, const Eigen::Vector3d& v, double unit = 1.0, double noise = rounding) {
    const Eigen::Vector3d clean = (v.array().abs() < noise).select(0.0, v);
    add(key, std::span<const double>(clean.data(), 3), unit);
  }
  // What is at its default is not said.
  void add_unless_zero(const std::string& key, double value) {
    if (value != 0.0) add(key, value);
  }
  void add_unless_zero(const std::string& key, const Eigen::Vector3d& v, double unit = 1.0,
                       double noise = rounding) {
    if (v.lpNorm<Eigen::Infinity>() > noise) add(key, v, unit, noise);
  }

  const std::string& text() const { return text_; }
  std::string braced() const { return "{" + text_ + "}"; }

 private:
  std::string separator_;
  std::string text_;
};

std::string shape_text(const Sphere& sphere) {
  Mapping of;
  of.add_unless_zero("centre_m", sphere.centre);
  of.add("radius_m", sphere.radius);
  return "{sphere: " + of.braced() + "}";
}

std::string shape_text(const Capsule& capsule) {
  Mapping of;
  of.add_unless_zero("from_m", capsule.begin);
  of.add("to_m", capsule.end);
  of.add("radius_m", capsule.radius);
  return "{capsule: " + of.braced() + "}";
}

std::string shape_text(const Box& box) {
  Mapping of;
  of.add_unless_zero("centre_m", box.centre);
  of.add_unless_zero("turned_deg", rotation_log(box.axes), degrees);
  of.add("half_lengths_m", box.half_lengths);
  return "{box: " + of.braced() + "}";
}

std::string shape_text(const ConvexHull& hull) {
  std::string points;
  for (const Eigen::Vector3d& point : hull.points) {
    Mapping of;
    of.add("p", point);
    points += (points.empty() ? "" : ", ") + of.text().substr(3);
  }
  Mapping of;
  of.add("points_m", "[" + points + "]");
  of.add_unless_zero("margin_m", hull.margin);
  return "{hull: " + of.braced() + "}";
}

void add_inertia(const RigidBodyInertia& body, Mapping& of) {
  const Eigen::Matrix3d& I = body.inertia;
  of.add("mass_kg", body.mass);
  of.add_unless_zero("centre_of_mass_m", body.centre_of_mass);
  const double noise = rounding * I.trace();
  of.add_unless_zero("inertia_kg_m2", I.diagonal(), 1.0, noise);
  of.add_unless_zero("inertia_products_kg_m2", Eigen::Vector3d(I(0, 1), I(0, 2), I(1, 2)), 1.0, noise);
}

std::string link_text(const LegLink& link) {
  Mapping of;
  add_inertia(link.inertia, of);
  std::string shapes;
  for (const Shape& shape : link.shapes) {
    shapes += shapes.empty() ? "" : ", ";
    shapes += std::visit([](const auto& one) { return shape_text(one); }, shape);
  }
  if (!shapes.empty()) of.add("shapes", "[" + shapes + "]");
  return of.braced();
}

/// How the keys of a joint that turns, or slides, end.
struct JointKeys {
  double position;
  const char *at, *armature, *viscous, *coulomb;
};

JointKeys keys_of(LegJointKind kind) {
  if (slides(kind)) return {1.0, "_m", "armature_kg", "viscous_Ns_per_m", "coulomb_N"};
  return {degrees, "_deg", "armature_kg_m2", "viscous_Nms_per_rad", "coulomb_Nm"};
}

const char* word_of(LegJointKind kind) {
  switch (kind) {
    case LegJointKind::prismatic:
      return "prismatic";
    case LegJointKind::universal:
      return "universal";
    case LegJointKind::spherical:
      return "spherical";
    case LegJointKind::screw:
      return "screw";
    case LegJointKind::revolute:
      break;
  }
  return "revolute";
}

void add_axes(const LegJoint& joint, Mapping& of) {
  of.add_unless_zero("at_m", joint.at);
  of.add_unless_zero("turned_deg", joint.turned, degrees);
  const bool along_z = joint.axis == Eigen::Vector3d::UnitZ();
  if (joint.kind != LegJointKind::spherical && !along_z) of.add("axis", joint.axis);
  if (joint.kind == LegJointKind::universal) of.add("second_axis", joint.second_axis);
  if (joint.kind == LegJointKind::screw) of.add("pitch_m", joint.pitch);
}

void add_coupling(const LegJoint& joint, const JointKeys& keys, Mapping& of) {
  if (joint.drive) {
    Mapping drive;
    drive.add_unless_zero(keys.armature, joint.drive->armature);
    if (joint.drive->ratio != 1.0) drive.add("ratio", joint.drive->ratio);
    drive.add_unless_zero(std::string("zero") + keys.at, joint.drive->zero * keys.position);
    of.add("drive", drive.braced());
  }
  if (joint.follows) {
    Mapping follows;
    follows.add_word("joint", joint.follows->joint);
    if (joint.follows->ratio != 1.0) follows.add("ratio", joint.follows->ratio);
    follows.add_unless_zero(std::string("offset") + keys.at, joint.follows->offset * keys.position);
    of.add("follows", follows.braced());
  }
  if (joint.measured) of.add("measured", "true");
}

void add_reference(const LegJoint& joint, const JointKeys& keys, Mapping& of) {
  const auto axes = static_cast<std::size_t>(axis_count(joint.kind));
  if (axes > 1) {
    of.add(std::string("reference") + keys.at, std::span(joint.reference.data(), axes), keys.position);
  } else {
    of.add_unless_zero(std::string("reference") + keys.at, joint.reference[0] * keys.position);
  }
}

// An end that is free is as far as files can say.
double bounded(double end) { return std::isfinite(end) ? end : std::copysign(1e6, end); }

std::string joint_text(const LegJoint& joint) {
  const JointKeys keys = keys_of(joint.kind);
  Mapping of;
  of.add_word("name", joint.name);
  if (!joint.on.empty()) of.add_word("on", joint.on);
  of.add("kind", word_of(joint.kind));
  add_axes(joint, of);
  add_coupling(joint, keys, of);
  add_reference(joint, keys, of);
  if (std::isfinite(joint.least) || std::isfinite(joint.most)) {
    const std::array<double, 2> range{bounded(joint.least), bounded(joint.most)};
    of.add(std::string("range") + keys.at, range, keys.position);
  }
  if (joint.friction.viscous != 0.0 || joint.friction.coulomb != 0.0) {
    Mapping friction;
    friction.add_unless_zero(keys.viscous, joint.friction.viscous);
    friction.add_unless_zero(keys.coulomb, joint.friction.coulomb);
    of.add("friction", friction.braced());
  }
  std::string text = "      - {" + of.text();
  if (joint.link) text += ",\n         link: " + link_text(*joint.link);
  return text + "}\n";
}

std::string closure_text(const LegClosure& closure) {
  Mapping of;
  if (!closure.joint.empty()) of.add_word("joint", closure.joint);
  of.add_unless_zero("at_m", closure.at);
  if (closure.holds_frame) {
    of.add("holds", "frame");
    of.add_unless_zero("turned_deg", closure.turned, degrees);
  }
  if (closure.on == LegClosure::On::joint) {
    of.add_word("on_joint", closure.on_joint);
    of.add("on_m", closure.on_at);
  } else {
    of.add(closure.on == LegClosure::On::base ? "on_base_m" : "on_platform_m", closure.on_at);
  }
  if (closure.holds_frame) of.add_unless_zero("on_turned_deg", closure.on_turned, degrees);
  return "      - " + of.braced() + "\n";
}

std::string leg_text(const RobotLeg& leg) {
  Mapping of("\n    ");
  of.add("at_m", leg.at);
  of.add_unless_zero("turned_deg", leg.turned, degrees);
  std::string text = "  - " + of.text() + "\n    joints:\n";
  for (const LegJoint& joint : leg.joints) text += joint_text(joint);
  text += "    closures:\n";
  for (const LegClosure& closure : leg.closures) text += closure_text(closure);
  return text;
}

// The word that says the same, or each number for itself.
void add_moves(const PlatformMoves& moves, Mapping& of) {
  for (const std::string& word : moves_words()) {
    const PlatformMoves meant = moves_of(word);
    if (meant.roles == moves.roles && meant.planar == moves.planar) return of.add("moves", word);
  }
  Mapping roles;
  for (std::size_t i = 0; i < chart_names.size(); ++i) {
    if (moves.roles[i] == ChartRole::fixed) continue;
    roles.add(std::string(chart_names[i]), moves.roles[i] == ChartRole::free ? "free" : "follows");
  }
  of.add("moves", "coordinates");
  of.add("coordinates", roles.braced());
}

std::string home_text(const LegsParameters& robot) {
  Mapping of;
  of.add("x_m", robot.home_position.x());
  of.add("y_m", robot.home_position.y());
  if (robot.moves.planar) {
    of.add_unless_zero("phi_deg", robot.home_rotation.z() * degrees);
  } else {
    of.add("z_m", robot.home_position.z());
    of.add_unless_zero("rotation_deg", robot.home_rotation, degrees);
  }
  return of.braced();
}

}  // namespace

std::string yaml_number(double value) {
  if (std::abs(value) < least_number) return "0";
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() ? std::string(digits.data(), end) : ".nan";
}

std::string legs_text(const LegsParameters& robot) {
  Mapping of("\n");
  of.add("kind", "legs");
  of.add_word("name", robot.name);
  add_moves(robot.moves, of);
  of.add("home_pose", home_text(robot));
  of.add("characteristic_length_m", robot.characteristic_length);
  of.add("gravity_m_per_s2", robot.gravity);
  of.add("platform", link_text(robot.platform));
  if (robot.payload) of.add("payload", link_text({*robot.payload, {}}));
  std::string text = of.text() + "\nlegs:\n";
  for (const RobotLeg& leg : robot.legs) text += leg_text(leg);
  if (robot.drive_map.empty()) return text;
  text += "drive_map:\n";
  for (const DriveSum& sum : robot.drive_map) {
    Mapping drive;
    for (const auto& [name, weight] : sum) drive.add(name, weight);
    text += "  - " + drive.braced() + "\n";
  }
  return text;
}

}  // namespace flinch
