#include "convert/urdf_text.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "convert/platform_at_home.h"
#include "convert/solids.h"
#include "convert/urdf_joints.h"
#include "convert/urdf_model.h"
#include "convert/xml_tag.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/legs/legs_model.h"

namespace flinch {
namespace {

std::string origin(const Eigen::Isometry3d& pose) {
  return XmlTag("origin")
      .numbers("xyz", pose.translation())
      .numbers("rpy", roll_pitch_yaw(pose.linear()))
      .closed();
}

/// A shape as geometry in the link.
struct Geometry {
  Eigen::Isometry3d pose;
  std::string text;
};

/// URDF has no capsule: a cylinder without its ends, which viewers show, and `flinch convert` reads as one.
struct GeometryOf {
  Geometry operator()(const Sphere& one) const {
    return {pose_at(one.centre, Eigen::Matrix3d::Identity()),
            XmlTag("sphere").number("radius", one.radius).closed()};
  }
  Geometry operator()(const Capsule& one) const {
    const Eigen::Vector3d along = one.end - one.begin;
    return {pose_at(0.5 * (one.begin + one.end), axes_with_z_along(along)),
            XmlTag("cylinder").number("radius", one.radius).number("length", along.norm()).closed()};
  }
  Geometry operator()(const Box& one) const {
    return {pose_at(one.centre, one.axes),
            XmlTag("box").numbers("size", Eigen::Vector3d(2.0 * one.half_lengths)).closed()};
  }
  Geometry operator()(const ConvexHull&) const { return {Eigen::Isometry3d::Identity(), ""}; }
};

/// A joint of one axis between two links.
struct TreeJoint {
  std::string name;
  std::string parent = {}, child = {};                   ///< Links.
  Eigen::Isometry3d at = Eigen::Isometry3d::Identity();  ///< Of the child's frame in the parent's, at zero.
  bool slides = false;
  Eigen::Vector3d axis{0.0, 0.0, 1.0};
};

class UrdfWriter {
 public:
  UrdfWriter(const LegsParameters& robot, double max_torque) : robot_(robot), max_torque_(max_torque) {
    AssembledLegs assembled = legs_model(robot);
    throw_if_any(std::move(assembled.problems));
    model_ = std::move(assembled.model);
    if (!robot.drive_map.empty())
      throw SetupError("drive_map: URDF has no drives that move with several joints");
  }

  UrdfTexts write() {
    line(0, "<!-- Written by flinch export. What closes the loops stands in the YAML file beside it. -->");
    line(0, XmlTag("robot").word("name", robot_.name).open());
    add_link("base", nullptr, {});
    add_platform();
    for (std::size_t i = 0; i < robot_.legs.size(); ++i) add_leg(i);
    text_ += transmissions_;
    line(0, "</robot>");
    return {std::move(text_),
            "# Written by flinch export: frames that coincide, joints that are driven, where joints are at "
            "home.\n"
            "closed_loop: [" +
                pairs_ + "]\ntype: [" + types_ + "]\nname_mot: [" + driven_ + "]\nzeros: {" + zeros() +
                "}\n"};
  }

 private:
  void line(std::size_t depth, const std::string& text) { text_ += indented(depth, text); }

  std::string zeros() const {
    const UrdfJoints joints(robot_);
    std::string text;
    for (std::size_t i = 0; i < joints.names().size(); ++i)
      add(text, joints.names()[i] + ": " + yaml_number(joints.at_home()[i]));
    return text;
  }

  static void add(std::string& list, const std::string& entry) { list += (list.empty() ? "" : ", ") + entry; }

  void add_link(const std::string& name, const RigidBodyInertia* body, const std::vector<Shape>& shapes) {
    XmlTag link("link");
    link.word("name", name);
    if (body == nullptr && shapes.empty()) return line(1, link.closed());
    line(1, link.open());
    if (body != nullptr) {
      const Eigen::Matrix3d& I = body->inertia;
      line(2, "<inertial>");
      line(3, origin(pose_at(body->centre_of_mass, Eigen::Matrix3d::Identity())));
      line(3, XmlTag("mass").number("value", body->mass).closed());
      line(3, XmlTag("inertia")
                  .number("ixx", I(0, 0))
                  .number("ixy", I(0, 1))
                  .number("ixz", I(0, 2))
                  .number("iyy", I(1, 1))
                  .number("iyz", I(1, 2))
                  .number("izz", I(2, 2))
                  .closed());
      line(2, "</inertial>");
    }
    for (const Shape& shape : shapes) {
      const Geometry geometry = std::visit(GeometryOf{}, shape);
      if (geometry.text.empty()) {
        line(2, "<!-- a hull is left out -->");
        continue;
      }
      for (const char* const use : {"visual", "collision"}) {
        line(2, "<" + std::string(use) + ">" + origin(geometry.pose) + "<geometry>" + geometry.text +
                    "</geometry></" + use + ">");
      }
    }
    line(1, "</link>");
  }

  /// URDF wants a range of what slides.
  void add_limit(const TreeJoint& joint, const ChainJoint* of, const LegJoint* description, bool is_limited) {
    const bool is_driven = description != nullptr && description->drive.has_value();
    if (!is_limited && !joint.slides && !is_driven) return;
    XmlTag limit("limit");
    if (is_limited || joint.slides) {
      limit.number("lower", is_limited ? of->least : -unlimited_slide)
          .number("upper", is_limited ? of->most : unlimited_slide);
    }
    const double ratio = is_driven ? std::abs(description->drive->ratio) : 0.0;
    line(2, limit.number("effort", max_torque_ * ratio).number("velocity", fastest).closed());
  }

  /// `of`: what the joint is besides; null of one without friction, limits and drive.
  void add_joint(const TreeJoint& joint, const ChainJoint* of, const LegJoint* description) {
    const bool is_limited = of != nullptr && std::isfinite(of->least) && std::isfinite(of->most);
    const char* const turns = is_limited ? "revolute" : "continuous";
    line(1, XmlTag("joint").word("name", joint.name).word("type", joint.slides ? "prismatic" : turns).open());
    line(2, origin(joint.at));
    line(2, XmlTag("parent").word("link", joint.parent).closed());
    line(2, XmlTag("child").word("link", joint.child).closed());
    line(2, XmlTag("axis").numbers("xyz", joint.axis).closed());
    add_limit(joint, of, description, is_limited);
    if (of != nullptr && (of->friction.viscous > 0.0 || of->friction.coulomb > 0.0)) {
      line(2, XmlTag("dynamics")
                  .number("damping", of->friction.viscous)
                  .number("friction", of->friction.coulomb)
                  .closed());
    }
    if (description != nullptr && description->follows) {
      line(2, XmlTag("mimic")
                  .word("joint", joint.name.substr(0, joint.name.find('_') + 1) + description->follows->joint)
                  .number("multiplier", description->follows->ratio)
                  .number_unless_zero("offset", description->follows->offset)
                  .closed());
    }
    line(1, "</joint>");
  }

  /// A frame without mass that is fixed on `parent`.
  void add_frame(const std::string& name, const std::string& parent, const Eigen::Isometry3d& at) {
    add_link(name, nullptr, {});
    line(1, XmlTag("joint").word("name", name + "_fixed").word("type", "fixed").open());
    line(2, origin(at));
    line(2, XmlTag("parent").word("link", parent).closed());
    line(2, XmlTag("child").word("link", name).closed());
    line(1, "</joint>");
  }

  /// The joints of the platform. What never moves stands in the frame of the first, or turned in the last.
  std::vector<TreeJoint> platform_joints() {
    const Eigen::Isometry3d home = platform_at_home(model_);
    Eigen::Vector3d stays = home.translation();
    std::vector<TreeJoint> joints;
    for (const std::size_t entry : platform_joint_entries(robot_.moves)) {
      const auto row = static_cast<Eigen::Index>(entry % 3);
      const bool slides = entry < 3;
      if (slides) stays[row] = 0.0;
      joints.push_back(
          {.name = platform_joint_name(entry), .slides = slides, .axis = Eigen::Vector3d::Unit(row)});
    }
    joints.front().at.translation() = stays;
    if (joints.back().slides) {
      joints.back().at.linear() = home.linear();
      joints.back().axis = home.linear().transpose() * joints.back().axis;
    }
    return joints;
  }

  void add_platform() {
    std::vector<TreeJoint> joints = platform_joints();
    std::string parent = "base";
    for (std::size_t j = 0; j + 1 < joints.size(); ++j) {
      joints[j].parent = parent;
      joints[j].child = parent = joints[j].name + "_link";
      add_link(parent, nullptr, {});
      add_joint(joints[j], nullptr, nullptr);
    }
    joints.back().parent = parent;
    joints.back().child = "platform";
    add_link("platform", &model_.platform, robot_.platform.shapes);
    add_joint(joints.back(), nullptr, nullptr);
  }

  static std::string link_name(std::size_t leg, const LegJoint& joint) {
    return name_in_model(leg, joint.name) + "_link";
  }

  void add_leg(std::size_t index) {
    const RobotLeg& leg = robot_.legs[index];
    std::vector<std::string> links;  // of each axis
    for (const LegJoint& joint : leg.joints) {
      if (joint.kind == LegJointKind::screw)
        throw SetupError("joint '" + joint.name + "' is a screw, which URDF has not");
      const int count = axis_count(joint.kind);
      for (int k = 1; k <= count; ++k) {
        const bool is_last = k == count;
        links.push_back(link_name(index, joint) + (is_last ? "" : "_" + std::to_string(k)));
        const LegLink* const link = is_last && joint.link ? &*joint.link : nullptr;
        add_link(links.back(), link == nullptr ? nullptr : &link->inertia,
                 link == nullptr ? std::vector<Shape>() : link->shapes);
        add_leg_joint(index, joint, leg_joint_name(index, joint, k), links);
      }
      if (joint.drive) add_drive(name_in_model(index, joint.name), *joint.drive);
    }
    for (std::size_t c = 0; c < leg.closures.size(); ++c) add_closure(index, c);
  }

  /// The joint of the last of `links`.
  void add_leg_joint(std::size_t index, const LegJoint& joint, const std::string& name,
                     const std::vector<std::string>& links) {
    const LegChain& chain = model_.legs[index].chain;
    const ChainJoint& one = chain.joints[links.size() - 1];
    const bool on_base = one.parent < 0;
    const Eigen::Isometry3d carrier =
        on_base ? pose_at(chain.base, chain.axes) : Eigen::Isometry3d(Eigen::Isometry3d::Identity());
    const TreeJoint tree{.name = name,
                         .parent = on_base ? "base" : links[static_cast<std::size_t>(one.parent)],
                         .child = links.back(),
                         .at = carrier * pose_at(one.at, one.turn),
                         .slides = one.slides,
                         .axis = one.turn.transpose() * one.axis};
    add_joint(tree, &one, &joint);
  }

  void add_drive(const std::string& joint, const LegDrive& drive) {
    add(driven_, joint);
    const std::string hardware = "hardware_interface/EffortJointInterface";
    transmissions_ +=
        indented(1, XmlTag("transmission").word("name", joint + "_drive").open()) +
        indented(2, "<type>transmission_interface/SimpleTransmission</type>") +
        indented(2, XmlTag("joint").word("name", joint).open() + "<hardwareInterface>" + hardware +
                        "</hardwareInterface></joint>") +
        indented(2, XmlTag("actuator").word("name", joint + "_motor").open() + "<mechanicalReduction>" +
                        yaml_number(drive.ratio) + "</mechanicalReduction></actuator>") +
        indented(1, "</transmission>");
  }

  void add_closure(std::size_t index, std::size_t c) {
    const RobotLeg& leg = robot_.legs[index];
    const LegClosure& closure = leg.closures[c];
    const std::string number = leg.closures.size() > 1 ? std::to_string(c + 1) : "";
    const std::string end = name_in_model(index, "end" + number);
    const LegJoint& joint =
        closure.joint.empty() ? leg.joints.back() : leg.joints[*joint_index(leg, closure.joint)];
    add_frame(end, link_name(index, joint), pose_at(closure.at, rotation_exp(closure.turned)));
    std::string other = "base";
    if (closure.on == LegClosure::On::platform) other = "platform";
    if (closure.on == LegClosure::On::joint)
      other = link_name(index, leg.joints[*joint_index(leg, closure.on_joint)]);
    const std::string there = end + "_on_" + (closure.on == LegClosure::On::joint ? closure.on_joint : other);
    add_frame(there, other, pose_at(closure.on_at, rotation_exp(closure.on_turned)));
    add(pairs_, "[" + end + ", " + there + "]");
    add(types_, closure.holds_frame ? "6d" : "3d");
  }

  static constexpr double fastest = 100.0;  // URDF wants one; flinch says no such thing of a joint

  const LegsParameters& robot_;
  double max_torque_ = 0.0;
  LegsModel model_;
  std::string text_, transmissions_, pairs_, types_, driven_;
};

}  // namespace

UrdfTexts urdf_texts(const LegsParameters& robot, double max_torque) {
  return UrdfWriter(robot, max_torque).write();
}

}  // namespace flinch
