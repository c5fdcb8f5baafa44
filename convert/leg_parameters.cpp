#include "convert/leg_parameters.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "systems/foundation/nearest_name.h"
#include "systems/robot/legs/platform_twist.h"

namespace flinch {
namespace {

constexpr double slenderness = 0.05;  // radius of a shape that stands in, of its length

LegJointKind kind_of_leg_joint(GraphJoint::Kind kind) {
  if (kind == GraphJoint::Kind::prismatic) return LegJointKind::prismatic;
  return kind == GraphJoint::Kind::screw ? LegJointKind::screw : LegJointKind::revolute;
}

class LegWriter {
 public:
  LegWriter(const BodyGraph& graph, const ClosedChains& chains, const ChainState& home,
            std::vector<std::string>& notes)
      : graph_(graph), chains_(chains), home_(home), notes_(notes) {}

  LegsParameters write(const PlatformMoves& moves) {
    LegsParameters robot;
    robot.name = graph_.name.empty() ? "robot" : graph_.name;
    robot.moves = moves;
    robot.home_position = home_.platform.translation();
    robot.home_rotation = rotation_log(home_.platform.linear());
    if (chains_.planar) {
      robot.home_position.z() = 0.0;
      robot.home_rotation.head<2>().setZero();
    }
    robot.gravity = chains_.bodies[graph_.base].linear() * graph_.gravity;
    robot.platform = platform();
    for (std::size_t i = 0; i < chains_.legs.size(); ++i) {
      if (is_guide(chains_.legs[i]) && (moves.following() == 0 || !holds_anything(i))) {
        notes_.push_back("joint '" + chains_.legs[i].links.front().name +
                         "' and those after it carry nothing and only guide the platform: " +
                         (moves.following() == 0 ? "`moves` says the same" : "the other legs hold it alike"));
      } else {
        robot.legs.push_back(leg(i));
      }
    }
    tell_stand_ins();
    return robot;
  }

 private:
  Eigen::Vector3d flat(Eigen::Vector3d point) const {
    if (chains_.planar) point.z() = 0.0;
    return point;
  }

  bool has_mass(const ChainLink& link) const {
    return link.body >= 0 && graph_.bodies[static_cast<std::size_t>(link.body)].inertia.mass > 0.0;
  }

  bool is_guide(const ChainLeg& leg) const {
    return std::none_of(leg.links.begin(), leg.links.end(), [&](const ChainLink& link) {
      const GraphJoint& joint = graph_.joints[link.joint];
      return has_mass(link) || joint.driven || joint.friction.viscous != 0.0 ||
             joint.friction.coulomb != 0.0 || std::isfinite(joint.least) || std::isfinite(joint.most);
    });
  }

  /// Whether more could move without this leg.
  bool holds_anything(std::size_t leg) const {
    ClosedChains others = chains_;
    ChainState there = home_;
    others.legs.erase(others.legs.begin() + static_cast<std::ptrdiff_t>(leg));
    there.s.erase(there.s.begin() + static_cast<std::ptrdiff_t>(leg));
    constexpr double length = 0.1;  // at which an angle counts as much as a distance [m]
    return free_motions(others, there, length).cols() != free_motions(chains_, home_, length).cols();
  }

  /// A body in a frame in which it stands at `pose`.
  LegLink link_of(const GraphBody& body, const Eigen::Isometry3d& pose) const {
    LegLink link{placed_at(pose, body.inertia), {}};
    link.inertia.centre_of_mass = flat(link.inertia.centre_of_mass);
    for (const Shape& shape : body.shapes) link.shapes.push_back(placed_at(pose, shape));
    return link;
  }

  LegLink platform() {
    const GraphBody& body = graph_.bodies[chains_.platform_body];
    if (!(body.inertia.mass > 0.0))
      graph_.refuse("link '" + body.name +
                    "' is the platform and has no mass; give it a mass and an inertia");
    LegLink link = link_of(body, chains_.frame_in_body.inverse());
    if (!link.shapes.empty()) return link;
    stand_ins_.insert("'" + body.name + "'");
    double radius = 0.0;
    for (const ChainLeg& leg : chains_.legs) {
      for (const ChainJoin& join : leg.joins) {
        if (join.on == ChainJoin::On::platform)
          radius = std::max(radius, flat(join.on_at.translation()).norm());
      }
    }
    link.shapes.emplace_back(Sphere{Eigen::Vector3d::Zero(), std::max(radius, 0.005)});
    return link;
  }

  RobotLeg leg(std::size_t index) {
    const ChainLeg& from = chains_.legs[index];
    RobotLeg leg;
    leg.at = from.links.front().origin;
    const std::vector<std::string> names = unique_names(from);
    for (std::size_t l = 0; l < from.links.size(); ++l)
      leg.joints.push_back(joint(from, l, names, home_.s[index], leg.at));
    for (const ChainJoin& join : from.joins) leg.closures.push_back(closure(from, join, names));
    give_shapes(from, leg);
    return leg;
  }

  static std::vector<std::string> unique_names(const ChainLeg& leg) {
    std::vector<std::string> names;
    std::set<std::string> taken{"base"};
    for (const ChainLink& link : leg.links) {
      std::string name = link.name;
      while (!taken.insert(name).second) name += "_";
      names.push_back(name);
    }
    return names;
  }

  LegJoint joint(const ChainLeg& from, std::size_t l, const std::vector<std::string>& names,
                 const Eigen::VectorXd& s, const Eigen::Vector3d& leg_at) const {
    const ChainLink& link = from.links[l];
    const GraphJoint& model = graph_.joints[link.joint];
    LegJoint joint;
    joint.name = names[l];
    joint.kind = kind_of_leg_joint(link.kind);
    const Eigen::Vector3d carried =
        link.parent < 0 ? leg_at : from.links[static_cast<std::size_t>(link.parent)].origin;
    joint.at = link.origin - carried;
    if (link.parent != static_cast<int>(l) - 1)
      joint.on = link.parent < 0 ? "base" : names[static_cast<std::size_t>(link.parent)];
    joint.axis = link.axis;
    joint.pitch = 2.0 * std::numbers::pi * link.lead;
    if (model.driven) joint.drive = LegDrive{model.armature, 1.0, model.zero};
    if (link.follows >= 0) {
      const ChainLink& leader = from.links[static_cast<std::size_t>(link.follows)];
      joint.follows = LegFollowing{names[static_cast<std::size_t>(link.follows)], link.ratio / leader.ratio,
                                   link.offset - link.ratio / leader.ratio * leader.offset};
    } else {
      joint.reference[0] = link.ratio * s[link.coordinate] + link.offset;
    }
    if (model.kind != GraphJoint::Kind::spherical) {
      joint.least = model.least - model.zero;
      joint.most = model.most - model.zero;
    }
    joint.friction = model.friction;
    if (has_mass(link)) {
      const auto body = static_cast<std::size_t>(link.body);
      joint.link = link_of(graph_.bodies[body], Eigen::Translation3d(-link.origin) * chains_.bodies[body]);
    }
    return joint;
  }

  LegClosure closure(const ChainLeg& from, const ChainJoin& join,
                     const std::vector<std::string>& names) const {
    LegClosure closure;
    if (join.link + 1 != from.links.size()) closure.joint = names[join.link];
    closure.at = flat(join.at.translation());
    closure.on_at = flat(join.on_at.translation());
    if (join.on == ChainJoin::On::base) closure.on = LegClosure::On::base;
    if (join.on == ChainJoin::On::link) {
      closure.on = LegClosure::On::joint;
      closure.on_joint = names[join.on_link];
    }
    closure.holds_frame = join.holds_frame;
    if (join.holds_frame)
      closure.on_turned = rotation_log(join.on_at.linear() * join.at.linear().transpose());
    if (chains_.planar) closure.on_turned.head<2>().setZero();
    return closure;
  }

  // Two links of a leg can be touched: the first and the last that there are.
  void give_shapes(const ChainLeg& from, RobotLeg& leg) {
    std::vector<std::size_t> links;
    for (std::size_t j = 0; j < leg.joints.size(); ++j) {
      if (leg.joints[j].link) links.push_back(j);
    }
    for (std::size_t i = 0; i < links.size(); ++i) {
      LegLink& link = *leg.joints[links[i]].link;
      if (i > 0 && i + 1 < links.size()) {
        if (!link.shapes.empty())
          notes_.push_back("link '" + name_of(from, links[i]) +
                           "' gets no shape: two links of a leg can be touched, the first and the last");
        link.shapes.clear();
      } else if (link.shapes.empty()) {
        stand_in(from, links[i], link);
      }
    }
  }

  std::string name_of(const ChainLeg& leg, std::size_t link) const {
    return graph_.bodies[static_cast<std::size_t>(leg.links[link].body)].name;
  }

  // From its joint to the farthest place where something else is joined to it.
  void stand_in(const ChainLeg& leg, std::size_t index, LegLink& link) {
    Eigen::Vector3d end = 2.0 * link.inertia.centre_of_mass;
    auto reach = [&end, first = true](const Eigen::Vector3d& place) mutable {
      if (first || place.norm() > end.norm()) end = place;
      first = false;
    };
    for (const ChainLink& other : leg.links) {
      if (other.parent == static_cast<int>(index)) reach(other.origin - leg.links[index].origin);
    }
    for (const ChainJoin& join : leg.joins) {
      if (join.link == index) reach(flat(join.at.translation()));
      if (join.on == ChainJoin::On::link && join.on_link == index) reach(flat(join.on_at.translation()));
    }
    if (!(end.norm() > 1e-9)) end = Eigen::Vector3d(0.0, 0.0, 1e-3);
    link.shapes.emplace_back(Capsule{Eigen::Vector3d::Zero(), end, slenderness * end.norm()});
    stand_ins_.insert("'" + name_of(leg, index) + "'");
  }

  void tell_stand_ins() {
    if (stand_ins_.empty()) return;
    const std::vector<std::string> names(stand_ins_.begin(), stand_ins_.end());
    notes_.push_back(
        "the model has no sphere, cylinder or box for " + listed(names) +
        ": capsules from joint to joint, and a sphere for the platform, stand in for what can be "
        "touched");
  }

  const BodyGraph& graph_;
  const ClosedChains& chains_;
  const ChainState& home_;
  std::vector<std::string>& notes_;
  std::set<std::string> stand_ins_;
};

}  // namespace

LegsParameters leg_parameters(const BodyGraph& graph, const ClosedChains& chains, const ChainState& home,
                              const PlatformMoves& moves, std::vector<std::string>& notes) {
  return LegWriter(graph, chains, home, notes).write(moves);
}

}  // namespace flinch
