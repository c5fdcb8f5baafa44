#include "convert/sdf_model.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "convert/urdf_model.h"
#include "systems/foundation/nearest_name.h"

namespace flinch {
namespace {

constexpr double unlimited = 1e15;  // as SDF writes ends that are free

class SdfReader {
 public:
  explicit SdfReader(const XmlElement& root) : root_(root) {}

  BodyGraph read() {
    graph_.file = root_.file;
    const XmlElement& model = find_model();
    graph_.name = model.required("name");
    for (const char* const nested : {"include", "model"}) {
      if (const XmlElement* const found = model.child(nested))
        found->refuse("stands in another model; write the model out whole, by 'gz sdf -p FILE'");
    }
    collect_places(model);
    for (const XmlElement* link : model.all("link")) add_link(*link);
    if (graph_.bodies.empty()) model.refuse("has no <link>");
    for (const XmlElement* frame : model.all("frame")) add_frame(*frame);
    for (const XmlElement* joint : model.all("joint")) add_joint(*joint);
    graph_.gravity = (pose_in(model).linear() * at_zero_[graph_.base].linear()).transpose() * graph_.gravity;
    return std::move(graph_);
  }

 private:
  /// Where something says that it stands: in what, and its element.
  struct Place {
    const XmlElement* element;
    std::string otherwise;  ///< Relative to what, if it says nothing; "": the model.
  };

  const XmlElement& find_model() {
    const XmlElement* of = &root_;
    if (const XmlElement* const world = root_.child("world")) {
      of = world;
      graph_.gravity = world->vector_in("gravity", graph_.gravity);
    }
    const std::vector<const XmlElement*> models = of->all("model");
    if (models.size() != 1)
      of->refuse("has " + std::to_string(models.size()) +
                 " elements <model>; one robot is converted at a time");
    return *models.front();
  }

  void collect_places(const XmlElement& model) {
    for (const XmlElement* link : model.all("link")) places_[link->required("name")] = {link, ""};
    for (const XmlElement* frame : model.all("frame"))
      places_[frame->required("name")] = {frame, frame->attribute("attached_to").value_or("")};
    for (const XmlElement* joint : model.all("joint")) {
      const XmlElement* const child = joint->child("child");
      if (child == nullptr) joint->refuse("needs a <parent> and a <child>");
      places_[joint->required("name")] = {joint, child->text};
    }
  }

  static Eigen::Isometry3d pose_in(const XmlElement& element) {
    const XmlElement* const pose = element.child("pose");
    if (pose == nullptr) return Eigen::Isometry3d::Identity();
    const std::vector<double> n = pose->text_numbers(7);
    if (n.empty()) return Eigen::Isometry3d::Identity();
    if (n.size() != 6 || pose->attribute("rotation_format").value_or("euler_rpy") != "euler_rpy")
      pose->refuse("must be six numbers: x y z roll pitch yaw");
    const double unit = pose->attribute("degrees") == "true" ? std::numbers::pi / 180.0 : 1.0;
    return pose_of({n[0], n[1], n[2]}, unit * Eigen::Vector3d(n[3], n[4], n[5]));
  }

  // Where nothing has moved, in the model.
  Eigen::Isometry3d place(const std::string& name, const XmlElement& asked, int depth = 0) const {
    if (name.empty() || name == "__model__" || name == "world") return Eigen::Isometry3d::Identity();
    const auto found = places_.find(name);
    if (found == places_.end()) {
      std::vector<std::string> known;
      for (const auto& [one, of] : places_) known.push_back(one);
      asked.refuse("stands relative to '" + name + "', which is no link, joint or frame" +
                   did_you_mean(name, known));
    }
    if (depth > 100) asked.refuse("stands relative to itself, by way of others");
    const Place& of = found->second;
    const XmlElement* const pose = of.element->child("pose");
    std::string relative_to = of.otherwise;
    if (pose != nullptr) relative_to = pose->attribute("relative_to").value_or(relative_to);
    return place(relative_to, *of.element, depth + 1) * pose_in(*of.element);
  }

  void add_link(const XmlElement& link) {
    GraphBody body;
    body.name = link.required("name");
    if (const XmlElement* const inertial = link.child("inertial")) {
      RigidBodyInertia inertia;
      inertia.mass = inertial->number_in("mass", 1.0);
      if (inertia.mass < 0.0) inertial->refuse("has a negative mass");
      inertia.inertia.setIdentity();
      if (const XmlElement* const about = inertial->child("inertia")) {
        const double xy = about->number_in("ixy", 0.0);
        const double xz = about->number_in("ixz", 0.0);
        const double yz = about->number_in("iyz", 0.0);
        inertia.inertia << about->number_in("ixx", 1.0), xy, xz, xy, about->number_in("iyy", 1.0), yz, xz, yz,
            about->number_in("izz", 1.0);
      }
      body.inertia = placed_at(pose_in(*inertial), inertia);
    }
    for (const XmlElement* collision : link.all("collision")) add_shape(*collision, body);
    at_zero_.push_back(place(body.name, link));
    graph_.add_body(std::move(body));
  }

  void add_shape(const XmlElement& collision, GraphBody& body) const {
    const XmlElement* const geometry = collision.child("geometry");
    if (geometry == nullptr) return;
    const Eigen::Isometry3d pose = pose_in(collision);
    for (const XmlElement& shape : geometry->children) {
      const double radius = shape.number_in("radius", 0.0);
      const Eigen::Vector3d end(0.0, 0.0, 0.5 * shape.number_in("length", 0.0));
      const Eigen::Vector3d half = 0.5 * shape.vector_in("size", Eigen::Vector3d::Zero());
      if (shape.name == "sphere" && radius > 0.0) {
        body.shapes.emplace_back(Sphere{pose.translation(), radius});
      } else if ((shape.name == "cylinder" || shape.name == "capsule") && radius > 0.0) {
        body.shapes.push_back(placed_at(pose, Capsule{-end, end, radius}));
      } else if (shape.name == "box" && half.minCoeff() > 0.0) {
        body.shapes.push_back(
            placed_at(pose, Box{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), half}));
      } else {
        body.has_mesh = true;
      }
    }
  }

  void add_frame(const XmlElement& frame) {
    std::string on = frame.required("name");
    for (int depth = 0; depth < 100; ++depth) {  // to the link that carries it
      const auto found = places_.find(on);
      if (found == places_.end() || found->second.element->name == "link") break;
      on = found->second.otherwise;
    }
    const auto is_link = [&on](const GraphFrame& one) { return one.name == on; };
    const auto link = std::find_if(graph_.frames.begin(), graph_.frames.end(), is_link);
    if (link == graph_.frames.end()) return;  // it is the model's
    const std::string name = frame.required("name");
    graph_.add_frame({name, link->body, at_zero_[link->body].inverse() * place(name, frame)});
  }

  std::size_t body_of(const XmlElement& joint, const char* side) {
    const XmlElement* const element = joint.child(side);
    if (element == nullptr || element->text.empty()) joint.refuse("needs a <parent> and a <child>");
    if (element->text != "world") return graph_.frame(element->text).body;
    if (!world_) {
      GraphBody world;
      world.name = "world";
      world_ = graph_.base = graph_.add_body(world);
      at_zero_.push_back(Eigen::Isometry3d::Identity());
    }
    return *world_;
  }

  void add_joint(const XmlElement& element) {
    const std::string name = element.required("name");
    const std::string type = element.required("type");
    for (const GraphJoint& other : graph_.joints) {
      if (other.name == name) element.refuse("has the name of another joint");
    }
    std::size_t parent = body_of(element, "parent");
    const std::size_t child = body_of(element, "child");
    if (parent == child) element.refuse("joins a link to itself");
    const Eigen::Isometry3d at = place(name, element);
    if (type == "universal" || type == "revolute2") {  // by a body without mass
      GraphBody cross;
      cross.name = name + "_cross";
      const std::size_t between = graph_.add_body(cross);
      at_zero_.push_back(at);
      add_axis(element, "axis", name + "_1", GraphJoint::Kind::revolute, parent, between, at);
      add_axis(element, "axis2", name + "_2", GraphJoint::Kind::revolute, between, child, at);
      return;
    }
    static const std::map<std::string, GraphJoint::Kind> kinds = {
        {"fixed", GraphJoint::Kind::fixed},         {"revolute", GraphJoint::Kind::revolute},
        {"continuous", GraphJoint::Kind::revolute}, {"prismatic", GraphJoint::Kind::prismatic},
        {"ball", GraphJoint::Kind::spherical},      {"screw", GraphJoint::Kind::screw}};
    const auto kind = kinds.find(type);
    if (kind == kinds.end())
      element.refuse(
          "is of type '" + type +
          "', which legs have not; those of gears write as a joint that follows, by hand in the robot "
          "file, and leave it out here");
    add_axis(element, "axis", name, kind->second, parent, child, at);
  }

  void add_axis(const XmlElement& element, const char* which, const std::string& name, GraphJoint::Kind kind,
                std::size_t parent, std::size_t child, const Eigen::Isometry3d& at) {
    GraphJoint joint;
    joint.name = name;
    joint.kind = kind;
    joint.parent = parent;
    joint.child = child;
    joint.in_parent = at_zero_[parent].inverse() * at;
    joint.in_child = at_zero_[child].inverse() * at;
    const bool has_axis = kind != GraphJoint::Kind::fixed && kind != GraphJoint::Kind::spherical;
    if (const XmlElement* const axis = element.child(which); axis != nullptr && has_axis)
      set_axis(*axis, at, joint);
    if (has_axis && element.child(which) == nullptr) element.refuse("has no <" + std::string(which) + ">");
    if (kind == GraphJoint::Kind::screw) {
      // One is in m a turn; the older one in turns a metre, with the other sign.
      const double pitch = element.number_in("screw_thread_pitch", 0.0);
      const double turns = element.number_in("thread_pitch", 0.0);
      joint.lead = pitch != 0.0 ? pitch / (2.0 * std::numbers::pi) : turns != 0.0 ? -1.0 / turns : 0.0;
      if (joint.lead == 0.0) element.refuse("is a screw without a pitch");
    }
    graph_.joints.push_back(std::move(joint));
  }

  void set_axis(const XmlElement& axis, const Eigen::Isometry3d& at, GraphJoint& joint) const {
    Eigen::Vector3d direction = axis.vector_in("xyz", Eigen::Vector3d::UnitZ());
    const XmlElement* const xyz = axis.child("xyz");
    std::string expressed_in = xyz == nullptr ? "" : xyz->attribute("expressed_in").value_or("");
    if (const XmlElement* const old = axis.child("use_parent_model_frame");
        old != nullptr && (old->text == "1" || old->text == "true"))
      expressed_in = "__model__";
    if (!expressed_in.empty())
      direction = at.linear().transpose() * (place(expressed_in, axis).linear() * direction);
    if (!(direction.norm() > 1e-9)) axis.refuse("has an xyz without length");
    joint.axis = direction.normalized();
    if (const XmlElement* const limit = axis.child("limit")) {
      const double least = limit->number_in("lower", -unlimited);
      const double most = limit->number_in("upper", unlimited);
      if (least < most && least > -unlimited) joint.least = least;
      if (least < most && most < unlimited) joint.most = most;
      joint.effort = std::max(0.0, limit->number_in("effort", 0.0));
    }
    if (const XmlElement* const dynamics = axis.child("dynamics")) {
      joint.friction.viscous = std::max(0.0, dynamics->number_in("damping", 0.0));
      joint.friction.coulomb = std::max(0.0, dynamics->number_in("friction", 0.0));
    }
    if (const XmlElement* const mimic = axis.child("mimic")) {
      joint.follows =
          GraphFollowing{mimic->required("joint"), mimic->number_in("multiplier", 1.0),
                         mimic->number_in("offset", 0.0) -
                             mimic->number_in("multiplier", 1.0) * mimic->number_in("reference", 0.0)};
    }
  }

  const XmlElement& root_;
  BodyGraph graph_;
  std::map<std::string, Place> places_;
  std::vector<Eigen::Isometry3d> at_zero_;  // of each body, in the model
  std::optional<std::size_t> world_;
};

}  // namespace

BodyGraph read_sdf(const XmlElement& root) { return SdfReader(root).read(); }

}  // namespace flinch
