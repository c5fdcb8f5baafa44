#include "convert/urdf_model.h"

#include <algorithm>

#include "systems/foundation/nearest_name.h"

namespace flinch {
namespace {

Eigen::Isometry3d origin_of(const XmlElement& element) {
  const XmlElement* const origin = element.child("origin");
  if (origin == nullptr) return Eigen::Isometry3d::Identity();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  return pose_of(origin->vector("xyz", zero), origin->vector("rpy", zero));
}

RigidBodyInertia inertia_of(const XmlElement& inertial) {
  RigidBodyInertia body;
  if (const XmlElement* const mass = inertial.child("mass")) body.mass = mass->number("value", 0.0);
  if (const XmlElement* const about = inertial.child("inertia")) {
    const double xy = about->number("ixy", 0.0);
    const double xz = about->number("ixz", 0.0);
    const double yz = about->number("iyz", 0.0);
    body.inertia << about->number("ixx", 0.0), xy, xz, xy, about->number("iyy", 0.0), yz, xz, yz,
        about->number("izz", 0.0);
  }
  if (body.mass < 0.0) inertial.refuse("has a negative mass");
  return placed_at(origin_of(inertial), body);
}

void add_shape(const XmlElement& collision, GraphBody& body) {
  const XmlElement* const geometry = collision.child("geometry");
  if (geometry == nullptr) return;
  const Eigen::Isometry3d pose = origin_of(collision);
  for (const XmlElement& shape : geometry->children) {
    const double radius = shape.number("radius", 0.0);
    if (shape.name == "sphere" && radius > 0.0) {
      body.shapes.emplace_back(Sphere{pose.translation(), radius});
    } else if ((shape.name == "cylinder" || shape.name == "capsule") && radius > 0.0) {
      const Eigen::Vector3d end(0.0, 0.0, 0.5 * shape.number("length", 0.0));
      body.shapes.push_back(placed_at(pose, Capsule{-end, end, radius}));
    } else if (shape.name == "box") {
      const Eigen::Vector3d half = 0.5 * shape.vector("size", Eigen::Vector3d::Zero());
      if (half.minCoeff() > 0.0)
        body.shapes.push_back(
            placed_at(pose, Box{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), half}));
    } else if (shape.name == "mesh") {
      body.has_mesh = true;
    }
  }
}

GraphBody body_of(const XmlElement& link) {
  GraphBody body;
  body.name = link.required("name");
  if (const XmlElement* const inertial = link.child("inertial")) body.inertia = inertia_of(*inertial);
  for (const XmlElement* collision : link.all("collision")) add_shape(*collision, body);
  return body;
}

GraphJoint::Kind kind_of_joint(const XmlElement& joint) {
  const std::string type = joint.required("type");
  if (type == "fixed") return GraphJoint::Kind::fixed;
  if (type == "revolute" || type == "continuous") return GraphJoint::Kind::revolute;
  if (type == "prismatic") return GraphJoint::Kind::prismatic;
  if (type == "floating" || type == "planar") {
    joint.refuse(
        "is " + type + ", a joint of " + (type == "planar" ? "three" : "six") +
        " ways to move, which a leg has not; write it as joints of one axis with links without mass");
  }
  joint.refuse("is of type '" + type + "', which is none of fixed, revolute, continuous, prismatic");
}

void set_limits(const XmlElement& element, GraphJoint& joint) {
  const XmlElement* const limit = element.child("limit");
  if (limit == nullptr) return;
  joint.effort = std::max(0.0, limit->number("effort", 0.0));
  const double least = limit->number("lower", 0.0);
  const double most = limit->number("upper", 0.0);
  if (element.attribute("type") == "continuous" || !(least < most)) return;
  if (joint.kind == GraphJoint::Kind::prismatic && std::min(-least, most) >= unlimited_slide) return;
  joint.least = least;
  joint.most = most;
}

GraphJoint joint_of(const XmlElement& element, const BodyGraph& graph) {
  GraphJoint joint;
  joint.name = element.required("name");
  joint.kind = kind_of_joint(element);
  const XmlElement* const parent = element.child("parent");
  const XmlElement* const child = element.child("child");
  if (parent == nullptr || child == nullptr) element.refuse("needs a <parent> and a <child>");
  joint.parent = graph.frame(parent->required("link")).body;
  joint.child = graph.frame(child->required("link")).body;
  if (joint.parent == joint.child) element.refuse("joins a link to itself");
  joint.in_parent = origin_of(element);
  if (joint.kind != GraphJoint::Kind::fixed) {
    const XmlElement* const axis = element.child("axis");
    joint.axis = axis == nullptr ? Eigen::Vector3d::UnitX() : axis->vector("xyz", Eigen::Vector3d::UnitX());
    if (!(joint.axis.norm() > 1e-9)) element.refuse("has an axis without length");
    joint.axis.normalize();
  }
  set_limits(element, joint);
  if (const XmlElement* const dynamics = element.child("dynamics")) {
    joint.friction.viscous = std::max(0.0, dynamics->number("damping", 0.0));
    joint.friction.coulomb = std::max(0.0, dynamics->number("friction", 0.0));
  }
  if (const XmlElement* const mimic = element.child("mimic"))
    joint.follows = {mimic->required("joint"), mimic->number("multiplier", 1.0),
                     mimic->number("offset", 0.0)};
  return joint;
}

std::size_t root_of(const BodyGraph& graph) {
  std::vector<bool> is_child(graph.bodies.size(), false);
  for (const GraphJoint& joint : graph.joints) is_child[joint.child] = true;
  const auto count = std::count(is_child.begin(), is_child.end(), false);
  if (count == 0) graph.refuse("has no link that is the child of no joint, so that nothing stands still");
  if (count > 1) {
    std::vector<std::string> roots;
    for (std::size_t i = 0; i < graph.bodies.size(); ++i) {
      if (!is_child[i]) roots.push_back(graph.bodies[i].name);
    }
    graph.refuse("has several links that are the child of no joint: " + listed(roots) +
                 "; join them by fixed joints");
  }
  return static_cast<std::size_t>(std::find(is_child.begin(), is_child.end(), false) - is_child.begin());
}

}  // namespace

Eigen::Isometry3d pose_of(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = xyz;
  pose.linear() = (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

BodyGraph read_urdf(const XmlElement& root) {
  BodyGraph graph;
  graph.file = root.file;
  graph.name = root.attribute("name").value_or("robot");
  for (const XmlElement& element : root.children) {
    if (element.name.find(':') != std::string::npos)
      element.refuse("is of xacro; write the model out by 'xacro FILE > model.urdf' first");
  }
  for (const XmlElement* link : root.all("link")) graph.add_body(body_of(*link));
  if (graph.bodies.empty()) root.refuse("has no <link>");
  for (const XmlElement* joint : root.all("joint")) {
    const GraphJoint one = joint_of(*joint, graph);
    for (const GraphJoint& other : graph.joints) {
      if (other.name == one.name) joint->refuse("has the name of another joint");
    }
    graph.joints.push_back(one);
  }
  graph.base = root_of(graph);
  for (const XmlElement* transmission : root.all("transmission")) {
    for (const XmlElement* joint : transmission->all("joint"))
      graph.joints[graph.joint(joint->required("name"))].driven = true;
  }
  return graph;
}

}  // namespace flinch
