#include "convert/mjcf_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "convert/solids.h"

namespace flinch {
namespace {

constexpr double water = 1000.0;  // density of geoms that say none [kg/m^3]

Eigen::Isometry3d translation(const Eigen::Vector3d& by) {
  return Eigen::Isometry3d(Eigen::Translation3d(by));
}

/// Values of attributes that an element and its classes have, nearest first.
class Attributes {
 public:
  explicit Attributes(std::vector<const XmlElement*> levels) : levels_(std::move(levels)) {}

  const XmlElement& said(std::string_view name) const {
    for (const XmlElement* level : levels_)
      if (level->attribute(name)) return *level;
    return *levels_.front();
  }
  bool has(std::string_view name) const { return said(name).attribute(name).has_value(); }
  double number(std::string_view name, double otherwise) const { return said(name).number(name, otherwise); }
  Eigen::Vector3d vector(std::string_view name, const Eigen::Vector3d& otherwise) const {
    return said(name).vector(name, otherwise);
  }
  std::vector<double> numbers(std::string_view name, std::size_t most) const {
    return said(name).numbers(name, most);
  }
  std::string word(std::string_view name, const std::string& otherwise) const {
    return said(name).attribute(name).value_or(otherwise);
  }

 private:
  std::vector<const XmlElement*> levels_;
};

class MjcfReader {
 public:
  explicit MjcfReader(const XmlElement& root) : root_(root) {}

  BodyGraph read() {
    graph_.file = root_.file;
    graph_.name = root_.attribute("model").value_or("robot");
    refuse_unread(root_);
    read_settings();
    for (const XmlElement* defaults : root_.all("default")) read_class(*defaults, "main", {});
    GraphBody world;
    world.name = "world";
    graph_.base = graph_.add_body(world);
    at_zero_.push_back(Eigen::Isometry3d::Identity());
    for (const XmlElement* worldbody : root_.all("worldbody")) {
      for (const XmlElement* body : worldbody->all("body")) read_body(*body, graph_.base, "main");
    }
    if (graph_.bodies.size() < 2) root_.refuse("has no <worldbody> with a <body>");
    for (const XmlElement* equality : root_.all("equality")) {
      for (const XmlElement& one : equality->children) read_equality(one);
    }
    for (const XmlElement* actuator : root_.all("actuator")) {
      for (const XmlElement& one : actuator->children) read_actuator(one);
    }
    for (const char* const unread : {"tendon", "contact", "deformable"}) {
      if (const XmlElement* const found = root_.child(unread); found && !found->children.empty())
        graph_.notes.push_back("<" + std::string(unread) +
                               "> is left out: a robot of legs has nothing like it");
    }
    return std::move(graph_);
  }

 private:
  // What would change the model if it were passed over.
  void refuse_unread(const XmlElement& element) const {
    static const std::set<std::string> unread = {"include",  "replicate", "composite",
                                                 "flexcomp", "attach",    "frame"};
    for (const XmlElement& child : element.children) {
      if (unread.count(child.name) > 0)
        child.refuse("is not read; let MuJoCo write the model out whole, by mj_saveLastXML or 'compile'");
    }
  }

  void read_settings() {
    for (const XmlElement* compiler : root_.all("compiler")) {
      if (compiler->attribute("angle") == "radian") angle_ = 1.0;
      if (compiler->attribute("coordinate") == "global")
        compiler->refuse("says coordinate=\"global\", which is not read");
      if (const auto sequence = compiler->attribute("eulerseq")) {
        if (sequence->size() != 3 || sequence->find_first_not_of("xyzXYZ") != std::string::npos)
          compiler->refuse("has eulerseq=\"" + *sequence + "\"; it must be three letters of xyzXYZ");
        euler_ = *sequence;
      }
    }
    for (const XmlElement* option : root_.all("option"))
      graph_.gravity = option->vector("gravity", graph_.gravity);
  }

  using Levels = std::map<std::string, std::vector<const XmlElement*>>;  // of each kind of element

  void read_class(const XmlElement& defaults, const std::string& otherwise, Levels levels) {
    const std::string name = defaults.attribute("class").value_or(otherwise);
    for (const XmlElement& child : defaults.children) {
      if (child.name != "default") levels[child.name].insert(levels[child.name].begin(), &child);
    }
    classes_[name] = levels;
    for (const XmlElement* child : defaults.all("default"))
      read_class(*child, child->required("class"), levels);
  }

  Attributes attributes(const XmlElement& element, const std::string& childclass) const {
    const std::string name = element.attribute("class").value_or(childclass);
    const auto found = classes_.find(name);
    if (found == classes_.end() && name != "main")
      element.refuse("has the class '" + name + "', which no <default> describes");
    std::vector<const XmlElement*> levels{&element};
    if (found != classes_.end()) {
      const auto of = found->second.find(element.name);
      if (of != found->second.end()) levels.insert(levels.end(), of->second.begin(), of->second.end());
    }
    return Attributes(levels);
  }

  Eigen::Matrix3d orientation(const Attributes& of) const {
    if (of.has("quat")) return quaternion(of.said("quat"), of.numbers("quat", 4));
    if (of.has("axisangle")) {
      const std::vector<double> v = of.numbers("axisangle", 4);
      const Eigen::Vector3d axis =
          v.size() == 4 ? Eigen::Vector3d(v[0], v[1], v[2]) : Eigen::Vector3d::Zero();
      if (!(axis.norm() > 1e-9)) of.said("axisangle").refuse("has an axisangle without axis and angle");
      return Eigen::AngleAxisd(angle_ * v[3], axis.normalized()).toRotationMatrix();
    }
    if (of.has("euler")) return turned(of.vector("euler", Eigen::Vector3d::Zero()));
    if (of.has("xyaxes")) {
      const std::vector<double> v = of.numbers("xyaxes", 6);
      Eigen::Matrix3d R;
      if (v.size() == 6) {
        const Eigen::Vector3d x = Eigen::Vector3d(v[0], v[1], v[2]).normalized();
        const Eigen::Vector3d z = x.cross(Eigen::Vector3d(v[3], v[4], v[5])).normalized();
        R << x, z.cross(x), z;
        if (R.allFinite() && z.norm() > 0.5) return R;
      }
      of.said("xyaxes").refuse("has xyaxes that are no two directions");
    }
    if (of.has("zaxis")) {
      const Eigen::Vector3d z = of.vector("zaxis", Eigen::Vector3d::UnitZ());
      if (!(z.norm() > 1e-9)) of.said("zaxis").refuse("has a zaxis without length");
      return axes_with_z_along(z);
    }
    return Eigen::Matrix3d::Identity();
  }

  static Eigen::Matrix3d quaternion(const XmlElement& element, const std::vector<double>& q) {
    const bool good = q.size() == 4 && Eigen::Map<const Eigen::Vector4d>(q.data()).norm() > 1e-6;
    if (!good) element.refuse("has a quaternion that is not four numbers, or 0");
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  }

  // Small letters turn about axes that move along, capital ones about those that stand.
  Eigen::Matrix3d turned(const Eigen::Vector3d& angles) const {
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    for (Eigen::Index i = 0; i < 3; ++i) {
      const char letter = euler_[static_cast<std::size_t>(i)];
      const Eigen::Index axis = (letter | 0x20) - 'x';
      const Eigen::Matrix3d one =
          Eigen::AngleAxisd(angle_ * angles[i], Eigen::Vector3d::Unit(axis)).toRotationMatrix();
      R = letter >= 'a' ? Eigen::Matrix3d(R * one) : Eigen::Matrix3d(one * R);
    }
    return R;
  }

  Eigen::Isometry3d pose(const Attributes& of) const {
    Eigen::Isometry3d result = translation(of.vector("pos", Eigen::Vector3d::Zero()));
    result.linear() = orientation(of);
    return result;
  }

  std::string free_name(const std::optional<std::string>& said, const char* what, std::size_t number) const {
    return said && !said->empty() ? *said : std::string(what) + "_" + std::to_string(number);
  }

  void read_body(const XmlElement& element, std::size_t parent, const std::string& inherited) {
    refuse_unread(element);
    const std::string childclass = element.attribute("childclass").value_or(inherited);
    if (element.attribute("mocap") == "true")
      element.refuse("is moved by a program (mocap), which no robot is");
    GraphBody body = read_inertia(element, childclass);
    body.name = free_name(element.attribute("name"), "body", graph_.bodies.size());
    const Eigen::Isometry3d in_parent = pose(Attributes({&element}));
    const std::string name = body.name;
    const bool is_free = element.child("freejoint") != nullptr || has_free_joint(element, childclass);
    const std::vector<const XmlElement*> joints = element.all("joint");
    const Eigen::Isometry3d at_zero = at_zero_[parent] * in_parent;
    std::size_t carrier = parent;
    Eigen::Isometry3d in_carrier = in_parent;
    if (!is_free && joints.size() > 1) {  // one after the other, by bodies without mass
      for (std::size_t j = 0; j + 1 < joints.size(); ++j) {
        GraphBody between;
        between.name = name + "_between_" + std::to_string(j + 1);
        const std::size_t next = graph_.add_body(between);
        at_zero_.push_back(at_zero);
        add_joint(*joints[j], childclass, carrier, next, in_carrier);
        carrier = next;
        in_carrier.setIdentity();
      }
    }
    const std::size_t index = graph_.add_body(std::move(body));
    at_zero_.push_back(at_zero);
    if (!is_free && joints.empty()) {
      GraphJoint held;
      held.name = name + "_held";
      held.parent = carrier;
      held.child = index;
      held.in_parent = in_carrier;
      graph_.joints.push_back(held);
    } else if (!is_free) {
      add_joint(*joints.back(), childclass, carrier, index, in_carrier);
    }
    for (const XmlElement* site : element.all("site")) {
      if (const auto site_name = site->attribute("name"))
        graph_.add_frame({*site_name, index, pose(attributes(*site, childclass))});
    }
    for (const XmlElement* child : element.all("body")) read_body(*child, index, childclass);
  }

  bool has_free_joint(const XmlElement& element, const std::string& childclass) const {
    const std::vector<const XmlElement*> joints = element.all("joint");
    return std::any_of(joints.begin(), joints.end(), [&](const XmlElement* joint) {
      return attributes(*joint, childclass).word("type", "hinge") == "free";
    });
  }

  void add_joint(const XmlElement& element, const std::string& childclass, std::size_t parent,
                 std::size_t child, const Eigen::Isometry3d& in_parent) {
    const Attributes of = attributes(element, childclass);
    GraphJoint joint;
    joint.name = free_name(element.attribute("name"), "joint", graph_.joints.size());
    for (const GraphJoint& other : graph_.joints) {
      if (other.name == joint.name) element.refuse("has the name of another joint");
    }
    const std::string type = of.word("type", "hinge");
    if (type == "hinge") {
      joint.kind = GraphJoint::Kind::revolute;
    } else if (type == "slide") {
      joint.kind = GraphJoint::Kind::prismatic;
    } else if (type == "ball") {
      joint.kind = GraphJoint::Kind::spherical;
    } else {
      element.refuse("is of type '" + type + "', which is none of hinge, slide, ball, free");
    }
    joint.parent = parent;
    joint.child = child;
    joint.in_child = translation(of.vector("pos", Eigen::Vector3d::Zero()));
    joint.in_parent = in_parent * joint.in_child;
    joint.axis = of.vector("axis", Eigen::Vector3d::UnitZ());
    if (!(joint.axis.norm() > 1e-9)) element.refuse("has an axis without length");
    joint.axis.normalize();
    const double unit = type == "hinge" ? angle_ : 1.0;
    joint.zero = unit * of.number("ref", 0.0);
    const std::vector<double> range = of.numbers("range", 2);
    const bool limited = of.word("limited", "auto") != "false";
    if (limited && range.size() == 2 && range[0] < range[1] && type != "ball") {
      joint.least = unit * range[0];
      joint.most = unit * range[1];
    }
    joint.armature = std::max(0.0, of.number("armature", 0.0));
    joint.friction.viscous = std::max(0.0, of.number("damping", 0.0));
    joint.friction.coulomb = std::max(0.0, of.number("frictionloss", 0.0));
    if (of.number("stiffness", 0.0) != 0.0)
      graph_.notes.push_back("the spring of joint '" + joint.name +
                             "' is left out: joints of legs have none");
    graph_.joints.push_back(std::move(joint));
  }

  // Of <inertial>, or of its geoms as solids.
  GraphBody read_inertia(const XmlElement& element, const std::string& childclass) {
    GraphBody body;
    const XmlElement* const inertial = element.child("inertial");
    RigidBodyInertia sum;
    for (const XmlElement* geom : element.all("geom")) {
      const RigidBodyInertia solid =
          read_geom(*geom, attributes(*geom, childclass), inertial != nullptr, body);
      if (solid.mass <= 0.0) continue;
      sum = sum.mass > 0.0 ? together(sum, solid) : solid;
    }
    body.inertia = inertial == nullptr ? sum : inertia_of(*inertial);
    return body;
  }

  RigidBodyInertia inertia_of(const XmlElement& inertial) const {
    RigidBodyInertia body;
    body.mass = inertial.number("mass", 0.0);
    if (body.mass < 0.0) inertial.refuse("has a negative mass");
    const std::vector<double> full = inertial.numbers("fullinertia", 6);
    if (full.size() == 6) {
      body.inertia << full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5], full[2];
    } else {
      body.inertia.diagonal() = inertial.vector("diaginertia", Eigen::Vector3d::Zero());
    }
    return placed_at(pose(Attributes({&inertial})), body);
  }

  RigidBodyInertia read_geom(const XmlElement& geom, const Attributes& of, bool has_inertial,
                             GraphBody& body) {
    const std::string type = of.word("type", of.has("mesh") ? "mesh" : "sphere");
    const std::vector<double> size = of.numbers("size", 3);
    const auto entry = [&](std::size_t i) { return i < size.size() ? size[i] : 0.0; };
    Eigen::Isometry3d at = pose(of);
    const double r = entry(0);
    double half = entry(1);
    if (of.has("fromto")) {
      const std::vector<double> ends = of.numbers("fromto", 6);
      if (ends.size() != 6) geom.refuse("has a fromto that is not six numbers");
      const Eigen::Vector3d from(ends[0], ends[1], ends[2]);
      const Eigen::Vector3d way = Eigen::Vector3d(ends[3], ends[4], ends[5]) - from;
      half = 0.5 * way.norm();
      at = translation(from + 0.5 * way);
      at.linear() = axes_with_z_along(way);
    }
    RigidBodyInertia shape;
    const auto mass_of = [&](double volume) {
      return of.number("mass", volume * of.number("density", water));
    };
    const bool touches = of.word("contype", "1") != "0" || of.word("conaffinity", "1") != "0";
    const Eigen::Vector3d end(0.0, 0.0, half);
    if (type == "sphere" && r > 0.0) {
      shape = solid_sphere(mass_of(sphere_volume(r)), r);
      if (touches) body.shapes.emplace_back(Sphere{at.translation(), r});
    } else if (type == "capsule" && r > 0.0 && half > 0.0) {
      shape = solid_capsule(mass_of(sphere_volume(r) + cylinder_volume(r, 2.0 * half)), r, 2.0 * half);
      if (touches) body.shapes.push_back(placed_at(at, Capsule{-end, end, r}));
    } else if (type == "cylinder" && r > 0.0 && half > 0.0) {
      shape = solid_cylinder(mass_of(cylinder_volume(r, 2.0 * half)), r, 2.0 * half);
      if (touches) body.shapes.push_back(placed_at(at, Capsule{-end, end, r}));
    } else if (type == "box" && r > 0.0 && half > 0.0 && entry(2) > 0.0) {
      const Eigen::Vector3d lengths(r, half, entry(2));
      shape = solid_box(mass_of(8.0 * lengths.prod()), lengths);
      if (touches)
        body.shapes.push_back(
            placed_at(at, Box{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), lengths}));
    } else if (type == "mesh" || type == "ellipsoid" || type == "sdf") {
      body.has_mesh = true;
      if (!has_inertial)
        geom.refuse("is a " + type + ", from which no mass is computed; give its body an <inertial>");
    } else if (type != "plane" && type != "hfield") {
      geom.refuse("is a " + type + " without a size, or no geom that is known");
    }
    return placed_at(at, shape);
  }

  std::size_t body_named(const XmlElement& element, const char* attribute) const {
    const auto name = element.attribute(attribute);
    return name ? graph_.frame(*name).body : graph_.base;
  }

  void read_equality(const XmlElement& element) {
    if (element.attribute("active") == "false") return;
    if (element.name == "joint") return read_coupling(element);
    const bool welds = element.name == "weld";
    if (!welds && element.name != "connect") {
      graph_.notes.push_back("<" + element.name +
                             "> of <equality> is left out: a robot of legs has nothing like it");
      return;
    }
    GraphJoint closure;
    closure.name = free_name(element.attribute("name"), element.name.c_str(), graph_.joints.size());
    closure.kind = welds ? GraphJoint::Kind::fixed : GraphJoint::Kind::spherical;
    closure.closes = true;
    if (element.attribute("site1")) {
      const GraphFrame& a = graph_.frame(element.required("site1"));
      const GraphFrame& b = graph_.frame(element.required("site2"));
      closure.parent = a.body;
      closure.in_parent = a.pose;
      closure.child = b.body;
      closure.in_child = b.pose;
    } else {
      element.required("body1");
      closure.parent = body_named(element, "body1");
      closure.child = body_named(element, "body2");
      const Eigen::Isometry3d second_in_first = at_zero_[closure.parent].inverse() * at_zero_[closure.child];
      if (welds) {
        closure.in_parent = relative_pose(element, second_in_first);
      } else {
        closure.in_parent = translation(element.vector("anchor", Eigen::Vector3d::Zero()));
        closure.in_child = second_in_first.inverse() * closure.in_parent;
      }
    }
    if (closure.parent == closure.child) element.refuse("holds a body on itself");
    graph_.joints.push_back(std::move(closure));
  }

  static Eigen::Isometry3d relative_pose(const XmlElement& element, const Eigen::Isometry3d& otherwise) {
    const std::vector<double> said = element.numbers("relpose", 7);
    if (said.size() != 7) return otherwise;
    const std::vector<double> q(said.begin() + 3, said.end());
    if (std::all_of(q.begin(), q.end(), [](double x) { return x == 0.0; })) return otherwise;
    Eigen::Isometry3d pose = translation({said[0], said[1], said[2]});
    pose.linear() = quaternion(element, q);
    return pose;
  }

  // y - y0 = a0 + a1 (x - x0), x0 and y0 where nothing has moved.
  void read_coupling(const XmlElement& element) {
    GraphJoint& follower = graph_.joints[graph_.joint(element.required("joint1"))];
    std::vector<double> a = element.numbers("polycoef", 5);
    if (a.empty()) a = {0.0, 1.0};
    for (std::size_t i = 2; i < a.size(); ++i)
      if (a[i] != 0.0) element.refuse("couples joints by a curve; joints of legs follow others at a ratio");
    a.resize(2, 0.0);
    if (!element.attribute("joint2"))
      element.refuse("holds a joint where it is; leave the joint out, so that its body is held");
    const GraphJoint& leader = graph_.joints[graph_.joint(element.required("joint2"))];
    follower.follows = GraphFollowing{leader.name, a[1], follower.zero + a[0] - a[1] * leader.zero};
  }

  void read_actuator(const XmlElement& element) {
    const auto name = element.attribute("joint");
    if (!name)
      return void(graph_.notes.push_back("<" + element.name + "> of <actuator> in line " +
                                         std::to_string(element.line) + " is left out: it drives no joint"));
    GraphJoint& joint = graph_.joints[graph_.joint(*name)];
    joint.driven = true;
    const Attributes of = attributes(element, "main");
    const std::vector<double> gear = of.numbers("gear", 6);
    std::vector<double> range = of.numbers("forcerange", 2);
    if (range.size() != 2 && element.name == "motor") range = of.numbers("ctrlrange", 2);
    if (range.size() == 2)
      joint.effort =
          std::max(std::abs(range[0]), std::abs(range[1])) * (gear.empty() ? 1.0 : std::abs(gear[0]));
  }

  const XmlElement& root_;
  BodyGraph graph_;
  std::vector<Eigen::Isometry3d> at_zero_;  // of each body, in the world
  std::map<std::string, Levels> classes_;
  double angle_ = std::numbers::pi / 180.0;
  std::string euler_ = "xyz";
};

}  // namespace

BodyGraph read_mjcf(const XmlElement& root) { return MjcfReader(root).read(); }

}  // namespace flinch
