#include "convert/legs_of_robot.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "systems/config/config_reader.h"
#include "systems/config/legs_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {
namespace {

using Vector = Eigen::Vector3d;

Vector in_plane(const Eigen::Vector2d& v) { return {v.x(), v.y(), 0.0}; }

struct PlanarLinks {
  LinkBody link1, link2;
};

/// Links with the base parameters of a leg: the centre of mass of the second lies in its middle, where that
/// leaves either a moment of inertia. The first is a thin rod.
///   m2 l1 s2 = p3,  I2 = p2 - m2 s2^2 > 0,  m1 l1^2 / 3 = p1 - p2 - m2 l1^2 > 0
PlanarLinks links_of(const PlanarLegParameters& leg) {
  const auto& [p1, p2, p3] = leg.inertia;
  const double l1 = leg.link1_length;
  const double least = p3 * l1 / (p1 - p2), most = p2 * l1 / p3;
  if (!(p3 > 0.0) || !(p1 > p2) || !(least < most))
    throw SetupError("base_parameters: no two links with their masses between their joints have them");
  const bool is_in_the_middle = least < 0.5 * leg.link2_length && 0.5 * leg.link2_length < most;
  const double s2 = is_in_the_middle ? 0.5 * leg.link2_length : std::sqrt(least * most);
  const double m2 = p3 / (l1 * s2);
  const double m1 = 3.0 * (p1 - p2 - m2 * l1 * l1) / (l1 * l1);
  return {.link1 = {m1, 0.5 * l1, m1 * l1 * l1 / 12.0}, .link2 = {m2, s2, p2 - m2 * s2 * s2}};
}

LegLink planar_link(const LinkBody& link, double length, double radius) {
  return {{link.mass, link.centre_of_mass * Vector::UnitX(), link.inertia * Eigen::Matrix3d::Identity()},
          {Capsule{.begin = Vector::Zero(), .end = length * Vector::UnitX(), .radius = radius}}};
}

RobotLeg planar_leg(const PlanarLegParameters& leg, const Eigen::Vector2d& base,
                    const Eigen::Vector2d& on_platform, double radius) {
  const PlanarLinks links = links_of(leg);
  LegJoint shoulder, elbow;
  shoulder.name = "shoulder";
  shoulder.drive = LegDrive{.armature = leg.rotor_inertia};
  shoulder.friction = leg.active_friction;
  shoulder.link = planar_link(links.link1, leg.link1_length, radius);
  elbow.name = "elbow";
  elbow.measured = true;
  elbow.at = leg.link1_length * Vector::UnitX();
  elbow.reference[0] = 0.5 * std::numbers::pi * leg.elbow_sign;
  elbow.friction = leg.passive_friction;
  elbow.link = planar_link(links.link2, leg.link2_length, radius);
  LegClosure closure;
  closure.at = leg.link2_length * Vector::UnitX();
  closure.on_at = in_plane(on_platform);
  return {.at = in_plane(base),
          .turned = leg.base_angle * Vector::UnitZ(),
          .joints = {shoulder, elbow},
          .closures = {closure}};
}

LegsParameters of(const PlanarRrrParameters& p) {
  LegsParameters robot;
  robot.name = p.name;
  robot.moves = moves_of("planar_pose");
  robot.home_position = {p.home_pose.x(), p.home_pose.y(), 0.0};
  robot.home_rotation = p.home_pose.z() * Vector::UnitZ();
  robot.characteristic_length = 1.0;
  robot.gravity = p.gravity;
  robot.platform = {{p.platform_mass, Vector::Zero(), p.platform_inertia * Eigen::Matrix3d::Identity()},
                    {Sphere{.radius = p.platform_hull_radius}}};
  for (const PlanarRrrLeg& leg : p.legs) {
    const Eigen::Vector2d base =
        leg.base_radius * Eigen::Vector2d(std::sin(leg.base_angle), -std::cos(leg.base_angle));
    const Eigen::Vector2d coupling =
        p.coupling_radius * Eigen::Vector2d(std::cos(leg.coupling_angle), std::sin(leg.coupling_angle));
    robot.legs.push_back(planar_leg(leg, base, coupling, p.link_radius));
  }
  return robot;
}

LegsParameters of(const FiveBarParameters& p) {
  LegsParameters robot;
  robot.name = p.name;
  robot.moves = moves_of("plane");
  robot.home_position = in_plane(p.home_pose);
  robot.characteristic_length = 1.0;
  robot.gravity = p.gravity;
  robot.platform = {{p.platform_mass, Vector::Zero(), Eigen::Matrix3d::Zero()},
                    {Sphere{.radius = p.platform_radius}}};
  for (const FiveBarLeg& leg : p.legs)
    robot.legs.push_back(planar_leg(leg, leg.base_joint, Eigen::Vector2d::Zero(), p.link_radius));
  return robot;
}

/// The frame of the universal joint at zero is that of the links: z along the leg, y the second axis, across
/// both.
RobotLeg hexapod_leg(const HexapodParameters& p, const HexapodLeg& leg) {
  const Vector k = leg.universal_axis;
  const Vector way = p.home_position + leg.platform_joint - leg.base_joint;
  const Vector s = (way - k.dot(way) * k).normalized();
  Eigen::Matrix3d frame;
  frame << -k, k.cross(s), s;
  const Eigen::AngleAxisd turned(frame);
  LegJoint foot, slide;
  foot.name = "foot";
  foot.kind = LegJointKind::universal;
  foot.axis = {-1.0, 0.0, 0.0};
  foot.friction = leg.universal_friction;
  foot.link = LegLink{
      scaled(p.cylinder, leg.mass_scale),
      {Capsule{
          .begin = Vector::Zero(), .end = p.cylinder_length * Vector::UnitZ(), .radius = p.cylinder_radius}}};
  slide.name = "slide";
  slide.kind = LegJointKind::prismatic;
  slide.drive = LegDrive{.armature = p.drive_armature};
  slide.reference[0] = way.norm();
  slide.least = p.rod_length;
  slide.most = p.rod_length + p.cylinder_length;
  slide.friction = leg.drive_friction;
  slide.link = LegLink{
      scaled(p.rod, leg.mass_scale),
      {Capsule{.begin = -p.rod_length * Vector::UnitZ(), .end = Vector::Zero(), .radius = p.rod_radius}}};
  LegClosure closure;
  closure.on_at = leg.platform_joint;
  return {.at = leg.base_joint,
          .turned = turned.angle() * turned.axis(),
          .joints = {foot, slide},
          .closures = {closure}};
}

LegsParameters of(const HexapodParameters& p) {
  LegsParameters robot;
  robot.name = p.name;
  robot.moves = moves_of("spatial_pose");
  robot.home_position = p.home_position;
  robot.home_rotation = p.home_rotation;
  robot.characteristic_length = p.characteristic_length;
  robot.gravity = p.gravity;
  robot.platform = {p.platform, {}};
  robot.payload = p.payload;
  for (const HexapodLeg& leg : p.legs) robot.legs.push_back(hexapod_leg(p, leg));
  return robot;
}

}  // namespace

LegsParameters as_legs(const ParallelRobot& robot) {
  if (const auto* planar = dynamic_cast<const PlanarRrr*>(&robot)) return of(planar->parameters());
  if (const auto* five_bar = dynamic_cast<const FiveBar*>(&robot)) return of(five_bar->parameters());
  if (const auto* hexapod = dynamic_cast<const Hexapod*>(&robot)) return of(hexapod->parameters());
  throw SetupError("'" + robot.name() +
                   "' is of a kind of its own; describe it as one of kind legs, of which models are made");
}

LegsParameters as_legs(const ParallelRobot& robot, const std::string& text,
                       const std::filesystem::path& file) {
  ConfigReader reader = ConfigReader::parse(text, file.string());
  std::string kind;
  reader.text("kind", kind);
  return kind == "legs" ? read_legs_parameters(reader) : as_legs(robot);
}

}  // namespace flinch
