#include "tests/systems/robot/written_legs.h"

#include <Eigen/Geometry>
#include <iomanip>
#include <numbers>
#include <sstream>

#include "systems/config/legs_file.h"
#include "systems/robot/rotation.h"

namespace flinch::test {
namespace {

using Vector = Eigen::Vector3d;

std::ostringstream exact() {
  std::ostringstream text;
  text << std::setprecision(17);
  return text;
}

std::string list(const Vector& v) {
  std::ostringstream text = exact();
  text << "[" << v.x() << ", " << v.y() << ", " << v.z() << "]";
  return text.str();
}

std::string about_z(double angle) { return list(angle * Vector::UnitZ()); }

std::string body(const RigidBodyInertia& b) {
  std::ostringstream text = exact();
  text << "mass_kg: " << b.mass << ", centre_of_mass_m: " << list(b.centre_of_mass)
       << ", inertia_kg_m2: " << list(b.inertia.diagonal())
       << ", inertia_products_kg_m2: " << list({b.inertia(0, 1), b.inertia(0, 2), b.inertia(1, 2)});
  return text.str();
}

std::string capsule(const Vector& from, const Vector& to, double radius) {
  std::ostringstream text = exact();
  text << ", shapes: [{capsule: {from_m: " << list(from) << ", to_m: " << list(to) << ", radius_m: " << radius
       << "}}]";
  return text.str();
}

std::string planar_link(const LinkBody& link, double length, double radius) {
  const RigidBodyInertia rigid{
      link.mass, {link.centre_of_mass, 0.0, 0.0}, link.inertia * Eigen::Matrix3d::Identity()};
  return "link: {" + body(rigid) + capsule(Vector::Zero(), length * Vector::UnitX(), radius) + "}";
}

std::string friction(const JointFriction& of, const char* viscous, const char* coulomb) {
  std::ostringstream text = exact();
  text << "friction: {" << viscous << ": " << of.viscous << ", " << coulomb << ": " << of.coulomb << "}";
  return text.str();
}

std::string turning_friction(const JointFriction& of) {
  return friction(of, "viscous_Nms_per_rad", "coulomb_Nm");
}

std::string planar_leg(const PlanarLegParameters& leg, const Eigen::Vector2d& base,
                       const Eigen::Vector2d& on_platform, const LinkBody& link1, const LinkBody& link2,
                       double radius) {
  std::ostringstream text = exact();
  text << "  - at_m: " << list({base.x(), base.y(), 0.0}) << "\n    turned_rad: " << about_z(leg.base_angle)
       << "\n    joints:\n      - {name: shoulder, kind: revolute, drive: {armature_kg_m2: "
       << leg.rotor_inertia << "}, " << turning_friction(leg.active_friction) << ", "
       << planar_link(link1, leg.link1_length, radius)
       << "}\n      - {name: elbow, kind: revolute, measured: true, at_m: "
       << list(leg.link1_length * Vector::UnitX()) << ", reference_deg: " << 90 * leg.elbow_sign << ", "
       << turning_friction(leg.passive_friction) << ", " << planar_link(link2, leg.link2_length, radius)
       << "}\n    closures: [{at_m: " << list(leg.link2_length * Vector::UnitX())
       << ", on_platform_m: " << list({on_platform.x(), on_platform.y(), 0.0}) << "}]\n";
  return text.str();
}

}  // namespace

std::string legs_text(const PlanarRrrParameters& p, const LinkBody& link1, const LinkBody& link2) {
  std::ostringstream text = exact();
  text << "kind: legs\nmoves: planar_pose\nhome_pose: {x_m: " << p.home_pose.x()
       << ", y_m: " << p.home_pose.y() << ", phi_rad: " << p.home_pose.z()
       << "}\ncharacteristic_length_m: 1\nplatform: {"
       << body({p.platform_mass, Vector::Zero(), p.platform_inertia * Eigen::Matrix3d::Identity()})
       << "}\nlegs:\n";
  for (const PlanarRrrLeg& leg : p.legs) {
    const Eigen::Vector2d base =
        leg.base_radius * Eigen::Vector2d(std::sin(leg.base_angle), -std::cos(leg.base_angle));
    const Eigen::Vector2d coupling =
        p.coupling_radius * Eigen::Vector2d(std::cos(leg.coupling_angle), std::sin(leg.coupling_angle));
    text << planar_leg(leg, base, coupling, link1, link2, p.link_radius);
  }
  return text.str();
}

std::string legs_text(const FiveBarParameters& p, const LinkBody& link1, const LinkBody& link2) {
  std::ostringstream text = exact();
  text << "kind: legs\nmoves: plane\nhome_pose: {x_m: " << p.home_pose.x() << ", y_m: " << p.home_pose.y()
       << "}\ncharacteristic_length_m: 1\nplatform: {mass_kg: " << p.platform_mass << "}\nlegs:\n";
  for (const FiveBarLeg& leg : p.legs)
    text << planar_leg(leg, leg.base_joint, Eigen::Vector2d::Zero(), link1, link2, p.link_radius);
  return text.str();
}

// The frame of a leg's universal joint at zero is that of the links: z along the leg, y the second axis,
// across both.
std::string legs_text(const HexapodParameters& p) {
  std::ostringstream text = exact();
  text << "kind: legs\nmoves: spatial_pose\nhome_pose: {x_m: " << p.home_position.x()
       << ", y_m: " << p.home_position.y() << ", z_m: " << p.home_position.z()
       << ", rotation_rad: " << list(p.home_rotation)
       << "}\ncharacteristic_length_m: " << p.characteristic_length
       << "\ngravity_m_per_s2: " << list(p.gravity) << "\nplatform: {" << body(p.platform) << "}\n";
  if (p.payload) text << "payload: {" << body(*p.payload) << "}\n";
  text << "legs:\n";
  for (const HexapodLeg& leg : p.legs) {
    const Vector k = leg.universal_axis;
    const Vector way = p.home_position + leg.platform_joint - leg.base_joint;
    const Vector s = (way - k.dot(way) * k).normalized();
    Eigen::Matrix3d frame;
    frame << -k, k.cross(s), s;
    const Eigen::AngleAxisd turned(frame);
    text << "  - at_m: " << list(leg.base_joint)
         << "\n    turned_rad: " << list(turned.angle() * turned.axis())
         << "\n    joints:\n      - {name: foot, kind: universal, axis: [-1, 0, 0], second_axis: [0, 1, 0], "
         << turning_friction(leg.universal_friction) << ", link: {"
         << body(scaled(p.cylinder, leg.mass_scale))
         << capsule(Vector::Zero(), p.cylinder_length * Vector::UnitZ(), p.cylinder_radius)
         << "}}\n      - {name: slide, kind: prismatic, axis: [0, 0, 1], drive: {armature_kg: "
         << p.drive_armature << "}, reference_m: " << way.norm() << ", range_m: [" << p.rod_length << ", "
         << p.rod_length + p.cylinder_length << "], "
         << friction(leg.drive_friction, "viscous_Ns_per_m", "coulomb_N") << ", link: {"
         << body(scaled(p.rod, leg.mass_scale))
         << capsule(-p.rod_length * Vector::UnitZ(), Vector::Zero(), p.rod_radius)
         << "}}\n    closures: [{on_platform_m: " << list(leg.platform_joint) << "}]\n";
  }
  return text.str();
}

LegsParameters legs_parameters_in(const std::string& text) {
  ConfigReader reader = ConfigReader::parse(text, "robot.yaml");
  std::string kind;
  reader.text("kind", kind);
  LegsParameters parameters = read_legs_parameters(reader);
  reader.finish();
  return parameters;
}

LegsRobot legs_robot_in(const std::string& text) { return LegsRobot(legs_parameters_in(text)); }

}  // namespace flinch::test
