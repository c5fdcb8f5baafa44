#include "convert/mjcf_text.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "convert/platform_at_home.h"
#include "convert/xml_tag.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/legs/legs_model.h"

namespace flinch {
namespace {

void add_pose(const Eigen::Isometry3d& pose, XmlTag& tag) {
  const Eigen::Quaterniond q(pose.linear());
  tag.numbers("pos", pose.translation());
  tag.numbers("quat", Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
}

/// MuJoCo refuses a rod without thickness and a point, which have no inertia about an axis.
Eigen::Matrix3d thick(const Eigen::Matrix3d& inertia) {
  const double least = std::max(1e-9 * inertia.trace(), 1e-12);
  if (inertia.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() >= least) return inertia;
  return inertia + least * Eigen::Matrix3d::Identity();
}

struct GeomText {
  std::string operator()(const Sphere& one) const {
    return XmlTag("geom")
        .word("type", "sphere")
        .numbers("pos", one.centre)
        .number("size", one.radius)
        .closed();
  }
  std::string operator()(const Capsule& one) const {
    Eigen::Matrix<double, 6, 1> ends;
    ends << one.begin, one.end;
    return XmlTag("geom").word("type", "capsule").numbers("fromto", ends).number("size", one.radius).closed();
  }
  std::string operator()(const Box& one) const {
    XmlTag tag("geom");
    tag.word("type", "box").numbers("size", one.half_lengths);
    add_pose(pose_at(one.centre, one.axes), tag);
    return tag.closed();
  }
  std::string operator()(const ConvexHull&) const { return "<!-- a hull is left out -->"; }
};

class MjcfWriter {
 public:
  explicit MjcfWriter(const LegsParameters& robot) : robot_(robot) {
    AssembledLegs assembled = legs_model(robot);
    throw_if_any(std::move(assembled.problems));
    model_ = std::move(assembled.model);
    if (!robot.drive_map.empty())
      throw SetupError("drive_map: MJCF has no drives that move with several joints");
  }

  std::string write() {
    line(0, "<!-- Written by flinch export. Where nothing has moved the robot is at home. -->");
    line(0, XmlTag("mujoco").word("model", robot_.name).open());
    line(1, XmlTag("compiler").word("angle", "radian").word("autolimits", "true").closed());
    line(1, XmlTag("option").numbers("gravity", robot_.gravity).closed());
    // Bodies of a robot lie in one another at its joints.
    line(1, "<default><geom contype=\"0\" conaffinity=\"0\"/></default>");
    line(1, "<worldbody>");
    write_platform();
    for (std::size_t i = 0; i < robot_.legs.size(); ++i) write_leg(i);
    line(1, "</worldbody>");
    line(1, "<equality>");
    text_ += equalities_;
    line(1, "</equality>");
    line(1, "<actuator>");
    text_ += actuators_;
    line(1, "</actuator>");
    line(0, "</mujoco>");
    return std::move(text_);
  }

 private:
  void line(std::size_t depth, const std::string& text) { text_ += indented(depth, text); }

  void write_body(std::size_t depth, const RigidBodyInertia& body, const std::vector<Shape>& shapes) {
    const Eigen::Matrix3d I = thick(body.inertia);
    Eigen::Matrix<double, 6, 1> full;
    full << I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2);
    line(depth, XmlTag("inertial")
                    .numbers("pos", body.centre_of_mass)
                    .number("mass", body.mass)
                    .numbers("fullinertia", full)
                    .closed());
    for (const Shape& shape : shapes) line(depth, std::visit(GeomText{}, shape));
  }

  void write_platform() {
    platform_ = platform_at_home(model_);
    XmlTag body("body");
    body.word("name", "platform");
    add_pose(platform_, body);
    line(2, body.open());
    const Eigen::Matrix3d to_body = platform_.linear().transpose();
    const auto& roles = robot_.moves.roles;
    const bool turns_in_space = roles[3] != ChartRole::fixed || roles[4] != ChartRole::fixed;
    if (turns_in_space) {
      line(3, "<freejoint name=\"platform_free\"/>");
    } else {
      for (std::size_t i = 0; i < 6; ++i) {
        if (roles[i] == ChartRole::fixed) continue;
        line(3, XmlTag("joint")
                    .word("name", "platform_" + std::string(chart_names[i]))
                    .word("type", i < 3 ? "slide" : "hinge")
                    .numbers("axis", Eigen::Vector3d(to_body.col(static_cast<Eigen::Index>(i % 3))))
                    .closed());
      }
    }
    write_body(3, model_.platform, robot_.platform.shapes);
    line(2, "</body>");
  }

  // The first of the axes of one turn each that a joint is, and how many they are.
  struct Axes {
    std::size_t first = 0, count = 0;
  };

  std::vector<Axes> axes_of_joints(const RobotLeg& leg) const {
    std::vector<Axes> axes;
    std::size_t next = 0;
    for (const LegJoint& joint : leg.joints) {
      if (joint.kind == LegJointKind::screw)
        throw SetupError("joint '" + joint.name + "' is a screw, which MJCF has not");
      axes.push_back({next, static_cast<std::size_t>(axis_count(joint.kind))});
      next += axes.back().count;
    }
    return axes;
  }

  void write_leg(std::size_t index) {
    const RobotLeg& leg = robot_.legs[index];
    const std::vector<Axes> axes = axes_of_joints(leg);
    ChainPlace place;
    model_.legs[index].chain.place(model_.legs[index].home, place);
    std::vector<Eigen::Isometry3d> poses;
    for (const Axes& of : axes) {
      const std::size_t last = of.first + of.count - 1;
      poses.push_back(pose_at(place.origin[last], place.axes[last]));
    }
    for (std::size_t j = 0; j < leg.joints.size(); ++j) {
      if (parent(leg, j) < 0) write_joint(index, j, axes, place, poses, 2);
    }
    for (std::size_t c = 0; c < leg.closures.size(); ++c) add_closure(index, c, poses);
  }

  static int parent(const RobotLeg& leg, std::size_t j) {
    const std::string& on = leg.joints[j].on;
    if (on.empty()) return static_cast<int>(j) - 1;
    return on == "base" ? -1 : static_cast<int>(*joint_index(leg, on));
  }

  void write_joint(std::size_t index, std::size_t j, const std::vector<Axes>& axes, const ChainPlace& place,
                   const std::vector<Eigen::Isometry3d>& poses, std::size_t depth) {
    const RobotLeg& leg = robot_.legs[index];
    const LegJoint& joint = leg.joints[j];
    const int on = parent(leg, j);
    XmlTag body("body");
    body.word("name", name_in_model(index, joint.name) + "_link");
    add_pose(on < 0 ? poses[j] : poses[static_cast<std::size_t>(on)].inverse() * poses[j], body);
    line(depth, body.open());
    for (std::size_t k = 0; k < axes[j].count; ++k) {
      const ChainJoint& one = model_.legs[index].chain.joints[axes[j].first + k];
      const double q = one.position(model_.legs[index].home);
      XmlTag tag("joint");
      const std::string suffix = axes[j].count > 1 ? "_" + std::to_string(k + 1) : "";
      tag.word("name", name_in_model(index, joint.name) + suffix)
          .word("type", one.slides ? "slide" : "hinge");
      tag.numbers("axis", Eigen::Vector3d(poses[j].linear().transpose() * place.axis[axes[j].first + k]));
      tag.number_unless_zero("ref", q).number_unless_zero("armature", one.armature);
      tag.number_unless_zero("damping", one.friction.viscous)
          .number_unless_zero("frictionloss", one.friction.coulomb);
      if (std::isfinite(one.least) && std::isfinite(one.most))
        tag.numbers("range", std::array<double, 2>{one.least, one.most});
      line(depth + 1, tag.closed());
      if (joint.follows) couple(index, joint, suffix);
    }
    if (joint.link) {
      write_body(depth + 1, joint.link->inertia, joint.link->shapes);
    } else {  // MuJoCo wants a mass of what moves.
      write_body(depth + 1, {1e-9, Eigen::Vector3d::Zero(), 1e-12 * Eigen::Matrix3d::Identity()}, {});
    }
    for (std::size_t k = 0; k < leg.joints.size(); ++k) {
      if (parent(leg, k) == static_cast<int>(j)) write_joint(index, k, axes, place, poses, depth + 1);
    }
    line(depth, "</body>");
    if (joint.drive) {
      actuators_ += indented(2, XmlTag("motor")
                                    .word("name", name_in_model(index, joint.name) + "_drive")
                                    .word("joint", name_in_model(index, joint.name))
                                    .number("gear", joint.drive->ratio)
                                    .closed());
    }
  }

  void couple(std::size_t index, const LegJoint& joint, const std::string& suffix) {
    equalities_ +=
        indented(2, XmlTag("joint")
                        .word("joint1", name_in_model(index, joint.name) + suffix)
                        .word("joint2", name_in_model(index, joint.follows->joint) + suffix)
                        .numbers("polycoef", std::array<double, 5>{0.0, joint.follows->ratio, 0.0, 0.0, 0.0})
                        .closed());
  }

  void add_closure(std::size_t index, std::size_t c, const std::vector<Eigen::Isometry3d>& poses) {
    const RobotLeg& leg = robot_.legs[index];
    const LegClosure& closure = leg.closures[c];
    const std::size_t a = closure.joint.empty() ? leg.joints.size() - 1 : *joint_index(leg, closure.joint);
    XmlTag tag(closure.holds_frame ? "weld" : "connect");
    tag.word("body1", name_in_model(index, leg.joints[a].name) + "_link");
    Eigen::Isometry3d other = Eigen::Isometry3d::Identity();
    if (closure.on == LegClosure::On::platform) {
      tag.word("body2", "platform");
      other = platform_;
    }
    if (closure.on == LegClosure::On::joint) {
      tag.word("body2", name_in_model(index, closure.on_joint) + "_link");
      other = poses[*joint_index(leg, closure.on_joint)];
    }
    if (closure.holds_frame) {
      const Eigen::Isometry3d pose = poses[a].inverse() * other;
      const Eigen::Quaterniond q(pose.linear());
      Eigen::Matrix<double, 7, 1> relative;
      relative << pose.translation(), q.w(), q.x(), q.y(), q.z();
      tag.numbers("relpose", relative);
    } else {
      tag.numbers("anchor", closure.at);
    }
    equalities_ += indented(2, tag.closed());
  }

  const LegsParameters& robot_;
  LegsModel model_;
  Eigen::Isometry3d platform_ = Eigen::Isometry3d::Identity();
  std::string text_, equalities_, actuators_;
};

}  // namespace

std::string mjcf_text(const LegsParameters& robot) { return MjcfWriter(robot).write(); }

}  // namespace flinch
