#include "convert/body_graph.h"

#include <algorithm>
#include <cmath>

#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr double largest_misfit = 1e-6;  // of what should coincide [m, rad]

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

double misfit(const Eigen::Isometry3d& pose) {
  return std::max(pose.translation().norm(), Eigen::AngleAxisd(pose.linear()).angle());
}

/// Makes one body of two, `kept` and `gone`, whose frame stands at `pose` in it.
void merge(BodyGraph& graph, std::size_t kept, std::size_t gone, const Eigen::Isometry3d& pose) {
  GraphBody& into = graph.bodies[kept];
  const GraphBody& from = graph.bodies[gone];
  const RigidBodyInertia moved = placed_at(pose, from.inertia);
  if (into.inertia.mass == 0.0 && into.inertia.inertia.isZero(0.0)) {
    into.inertia = moved;
  } else if (moved.mass > 0.0 || !moved.inertia.isZero(0.0)) {
    into.inertia = together(into.inertia, moved);
  }
  for (const Shape& shape : from.shapes) into.shapes.push_back(placed_at(pose, shape));
  into.has_mesh = into.has_mesh || from.has_mesh;
  for (GraphFrame& frame : graph.frames) {
    if (frame.body != gone) continue;
    frame.body = kept;
    frame.pose = pose * frame.pose;
  }
  for (GraphJoint& joint : graph.joints) {
    if (joint.parent == gone) {
      joint.parent = kept;
      joint.in_parent = pose * joint.in_parent;
    }
    if (joint.child == gone) {
      joint.child = kept;
      joint.in_child = pose * joint.in_child;
    }
  }
  graph.bodies[gone] = GraphBody{};  // with no name: gone
}

void merge_fixed(BodyGraph& graph) {
  for (std::size_t j = 0; j < graph.joints.size();) {
    const GraphJoint joint = graph.joints[j];
    if (joint.kind != GraphJoint::Kind::fixed) {
      ++j;
      continue;
    }
    graph.joints.erase(graph.joints.begin() + static_cast<std::ptrdiff_t>(j));
    const Eigen::Isometry3d child_in_parent = joint.in_parent * joint.in_child.inverse();
    if (joint.parent == joint.child) {
      if (misfit(child_in_parent) > largest_misfit)
        graph.refuse("joint '" + joint.name + "' holds two places of one rigid part that do not coincide");
      continue;
    }
    if (joint.child == graph.base) {
      merge(graph, joint.child, joint.parent, child_in_parent.inverse());
    } else {
      merge(graph, joint.parent, joint.child, child_in_parent);
    }
  }
  for (const GraphJoint& joint : graph.joints) {
    if (joint.parent == joint.child)
      graph.refuse("joint '" + joint.name + "' joins a rigid part to itself, so that it cannot move");
  }
}

bool is_free_hinge(const GraphJoint& joint) {
  return joint.kind == GraphJoint::Kind::revolute && !joint.driven && !joint.follows;
}

struct Line {
  Eigen::Vector3d point, direction;
};

Line line_in(std::size_t body, const GraphJoint& joint) {
  const Eigen::Isometry3d& frame = joint.child == body ? joint.in_child : joint.in_parent;
  return {frame.translation(), frame.linear() * joint.axis};
}

bool on_one_line(const Line& a, const Line& b) {
  const Eigen::Vector3d way = b.point - a.point;
  return a.direction.cross(b.direction).norm() < largest_misfit &&
         a.direction.cross(way).norm() < largest_misfit;
}

/// Fixes one hinge of a body that spins between two; false where there is none.
bool hold_spinning_body(BodyGraph& graph, std::size_t platform) {
  for (std::size_t body = 0; body < graph.bodies.size(); ++body) {
    if (body == graph.base || body == platform) continue;
    std::vector<GraphJoint*> hinges;
    bool others = false;
    for (GraphJoint& joint : graph.joints) {
      if (joint.parent != body && joint.child != body) continue;
      if (!is_free_hinge(joint)) others = true;
      hinges.push_back(&joint);
    }
    if (others || hinges.size() != 2) continue;
    if (!on_one_line(line_in(body, *hinges[0]), line_in(body, *hinges[1]))) continue;
    const auto neighbour = [body](const GraphJoint& joint) {
      return joint.parent == body ? joint.child : joint.parent;
    };
    GraphJoint& held = neighbour(*hinges[0]) == platform ? *hinges[1] : *hinges[0];
    graph.notes.push_back("link '" + graph.bodies[body].name +
                          "' spins between two hinges about one line, '" + hinges[0]->name + "' and '" +
                          hinges[1]->name + "': it is held on '" + graph.bodies[neighbour(held)].name + "'");
    held.kind = GraphJoint::Kind::fixed;
    return true;
  }
  return false;
}

/// Takes away bodies that are gone.
void renumber(BodyGraph& graph) {
  std::vector<std::size_t> number(graph.bodies.size(), 0);
  std::vector<GraphBody> left;
  for (std::size_t i = 0; i < graph.bodies.size(); ++i) {
    if (graph.bodies[i].name.empty()) continue;
    number[i] = left.size();
    left.push_back(std::move(graph.bodies[i]));
  }
  graph.bodies = std::move(left);
  graph.base = number[graph.base];
  for (GraphFrame& frame : graph.frames) frame.body = number[frame.body];
  for (GraphJoint& joint : graph.joints) {
    joint.parent = number[joint.parent];
    joint.child = number[joint.child];
  }
}

}  // namespace

void BodyGraph::refuse(const std::string& complaint) const { throw SetupError(file + ": " + complaint); }

std::size_t BodyGraph::add_body(GraphBody body) {
  if (body.name.empty()) refuse("a link has no name");
  add_frame({body.name, bodies.size(), Eigen::Isometry3d::Identity()});
  bodies.push_back(std::move(body));
  return bodies.size() - 1;
}

void BodyGraph::add_frame(GraphFrame one) {
  for (const GraphFrame& other : frames) {
    if (other.name == one.name) refuse("the name '" + one.name + "' is that of two links or frames");
  }
  frames.push_back(std::move(one));
}

const GraphFrame& BodyGraph::frame(const std::string& frame_name) const {
  for (const GraphFrame& one : frames) {
    if (one.name == frame_name) return one;
  }
  const std::vector<std::string> known = names_of(frames);
  refuse("has no link or frame '" + frame_name + "'" + did_you_mean(frame_name, known));
}

std::size_t BodyGraph::joint(const std::string& joint_name) const {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].name == joint_name) return j;
  }
  const std::vector<std::string> known = names_of(joints);
  refuse("has no joint '" + joint_name + "'" + did_you_mean(joint_name, known));
}

void BodyGraph::set_driven(const std::vector<std::string>& driven) {
  for (GraphJoint& one : joints) one.driven = false;
  for (const std::string& name_of_joint : driven) joints[joint(name_of_joint)].driven = true;
}

BodyGraph without_fixed_joints(BodyGraph graph, const std::string& platform) {
  do merge_fixed(graph);
  while (hold_spinning_body(graph, graph.frame(platform).body));
  renumber(graph);
  return graph;
}

RigidBodyInertia placed_at(const Eigen::Isometry3d& pose, const RigidBodyInertia& body) {
  const Eigen::Matrix3d R = pose.linear();
  return {body.mass, pose * body.centre_of_mass, R * body.inertia * R.transpose()};
}

Shape placed_at(const Eigen::Isometry3d& pose, const Shape& shape) {
  struct Place {
    const Eigen::Isometry3d& pose;
    Shape operator()(Sphere one) const { return one.centre = pose * one.centre, one; }
    Shape operator()(Capsule one) const {
      one.begin = pose * one.begin;
      one.end = pose * one.end;
      return one;
    }
    Shape operator()(Box one) const {
      one.centre = pose * one.centre;
      one.axes = pose.linear() * one.axes;
      return one;
    }
    Shape operator()(ConvexHull one) const {
      for (Eigen::Vector3d& point : one.points) point = pose * point;
      return one;
    }
  };
  return std::visit(Place{pose}, shape);
}

}  // namespace flinch
