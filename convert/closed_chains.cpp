#include "convert/closed_chains.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "systems/foundation/nearest_name.h"

namespace flinch {
namespace {

using Kind = GraphJoint::Kind;

/// A joint as seen from one of its bodies: frame on this side, frame on the other, axis in it.
struct Side {
  std::size_t from, to;
  Eigen::Isometry3d near, far;
  Eigen::Vector3d axis;
};

Side side_of(const GraphJoint& joint, std::size_t from) {
  if (joint.parent == from) return {from, joint.child, joint.in_parent, joint.in_child, joint.axis};
  return {from, joint.parent, joint.in_child, joint.in_parent, -joint.axis};
}

/// Two directions across `along` and one another.
std::pair<Eigen::Vector3d, Eigen::Vector3d> across(const Eigen::Vector3d& along) {
  const Eigen::Vector3d first = along.unitOrthogonal();
  return {first, along.normalized().cross(first)};
}

class ChainBuilding {
 public:
  ChainBuilding(const BodyGraph& graph, const ChainSettings& settings)
      : graph_(graph),
        settings_(settings),
        leg_of_(graph.bodies.size(), none),
        link_of_(graph.bodies.size(), -1) {
    const GraphFrame& frame = graph.frame(settings.platform);
    chains_.platform_body = frame.body;
    chains_.frame_in_body = frame.pose;
    chains_.planar = settings.planar;
    chains_.bodies.assign(graph.bodies.size(), Eigen::Isometry3d::Identity());
    placed_.assign(graph.bodies.size(), false);
    used_.assign(graph.joints.size(), false);
  }

  ClosedChains build() {
    if (chains_.platform_body == graph_.base)
      graph_.refuse("--platform '" + settings_.platform + "' is part of the base, '" +
                    graph_.bodies[graph_.base].name + "', and cannot move");
    chains_.bodies[graph_.base].linear() = settings_.base_axes.transpose();
    placed_[graph_.base] = true;
    find_components();
    for (std::size_t leg = 0; leg < components_; ++leg) grow(leg);
    place_platform();
    for (std::size_t leg = 0; leg < components_; ++leg) close(leg);
    join_base_and_platform();
    order_legs();
    resolve_followers();
    return std::move(chains_);
  }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  bool is_inner(std::size_t body) const { return body != graph_.base && body != chains_.platform_body; }

  // Bodies are of one leg where joints lead from one to the other past base and platform.
  void find_components() {
    std::vector<std::size_t> group(graph_.bodies.size());
    std::iota(group.begin(), group.end(), 0);
    for (bool changed = true; changed;) {
      changed = false;
      for (const GraphJoint& joint : graph_.joints) {
        if (!is_inner(joint.parent) || !is_inner(joint.child)) continue;
        const std::size_t least = std::min(group[joint.parent], group[joint.child]);
        changed = changed || group[joint.parent] != least || group[joint.child] != least;
        group[joint.parent] = group[joint.child] = least;
      }
    }
    for (std::size_t body = 0; body < group.size(); ++body) {
      if (!is_inner(body)) continue;
      if (group[body] == body) leg_of_[body] = components_++;
      leg_of_[body] = leg_of_[group[body]];
    }
    chains_.legs.resize(components_);
    for (std::size_t leg = 0; leg < components_; ++leg) check_component(leg);
  }

  void check_component(std::size_t leg) const {
    bool on_base = false;
    bool on_platform = false;
    for (const GraphJoint& joint : graph_.joints) {
      for (const auto& [one, other] :
           {std::pair(joint.parent, joint.child), std::pair(joint.child, joint.parent)}) {
        if (leg_of_[one] != leg) continue;
        on_base = on_base || other == graph_.base;
        on_platform = on_platform || other == chains_.platform_body;
      }
    }
    const auto named = [&] {
      const auto first = std::find(leg_of_.begin(), leg_of_.end(), leg);
      return "link '" + graph_.bodies[static_cast<std::size_t>(first - leg_of_.begin())].name + "'";
    };
    if (!on_base && !on_platform)
      graph_.refuse(named() + " hangs on nothing: no joint leads from it to the base");
    if (!on_base) {
      graph_.refuse(
          named() + " hangs on the platform, '" + graph_.bodies[chains_.platform_body].name +
          "', and does not reach the base; fix it to the platform, or name it as --platform if it is "
          "what the robot moves");
    }
    if (!on_platform) {
      graph_.refuse(named() + " stands on the base and does not reach the platform, '" +
                    graph_.bodies[chains_.platform_body].name +
                    "': it is no leg; take it out of the model, or name another --platform");
    }
  }

  // Driven joints are of the tree, ball joints are left to close loops.
  int rank(const GraphJoint& joint) const {
    if (joint.driven) return 0;
    return joint.kind == Kind::spherical ? 2 : joint.closes ? 1 : 0;
  }

  void grow(std::size_t leg) {
    while (true) {
      std::size_t best = none;
      for (std::size_t j = 0; j < graph_.joints.size(); ++j) {
        const GraphJoint& joint = graph_.joints[j];
        if (used_[j] || !leads_on(joint, leg)) continue;
        if (best == none || rank(joint) < rank(graph_.joints[best])) best = j;
      }
      if (best == none) return;
      used_[best] = true;
      const GraphJoint& joint = graph_.joints[best];
      add(leg, best, side_of(joint, placed_[joint.parent] ? joint.parent : joint.child));
    }
  }

  // From a body that is placed to one of the leg that is not.
  bool leads_on(const GraphJoint& joint, std::size_t leg) const {
    const auto leads = [&](std::size_t from, std::size_t to) {
      return leg_of_[to] == leg && !placed_[to] && placed_[from] &&
             (from == graph_.base || leg_of_[from] == leg);
    };
    return leads(joint.parent, joint.child) || leads(joint.child, joint.parent);
  }

  Eigen::Isometry3d frame_of(const Side& side) const { return chains_.bodies[side.from] * side.near; }

  Eigen::Vector3d flat(Eigen::Vector3d point) const {
    if (settings_.planar) point.z() = 0.0;
    return point;
  }

  // In the plane axes are exact.
  Eigen::Vector3d direction(const Eigen::Vector3d& axis, bool turns) const {
    if (!settings_.planar) return axis;
    if (turns) return Eigen::Vector3d(0.0, 0.0, axis.z() < 0.0 ? -1.0 : 1.0);
    return flat(axis).normalized();
  }

  int parent_of(std::size_t body) const { return body == graph_.base ? -1 : link_of_[body]; }

  ChainLink link_at(std::size_t leg, std::size_t j, const Side& side) {
    const GraphJoint& joint = graph_.joints[j];
    const Eigen::Isometry3d frame = frame_of(side);
    ChainLink link;
    link.joint = j;
    link.name = joint.name;
    link.kind = joint.kind;
    link.parent = parent_of(side.from);
    link.origin = flat(frame.translation());
    link.axis = direction(frame.linear() * side.axis, joint.turns());
    link.lead = joint.lead;
    link.coordinate = chains_.legs[leg].coordinates++;
    return link;
  }

  void add(std::size_t leg, std::size_t j, const Side& side) {
    const GraphJoint& joint = graph_.joints[j];
    std::vector<ChainLink>& links = chains_.legs[leg].links;
    ChainLink link = link_at(leg, j, side);
    chains_.bodies[side.to] = frame_of(side) * side.far.inverse();
    placed_[side.to] = true;
    if (joint.kind == Kind::spherical) {
      add_ball(leg, side, link);
    } else {
      links.push_back(link);
    }
    links.back().body = static_cast<int>(side.to);
    link_of_[side.to] = static_cast<int>(links.size()) - 1;
  }

  // Three axes one after the other; two across a rod that is held by balls at both ends, and by nothing else.
  void add_ball(std::size_t leg, const Side& side, ChainLink link) {
    if (graph_.joints[link.joint].driven)
      graph_.refuse("joint '" + link.name + "' is a ball joint, which no drive turns");
    std::vector<Eigen::Vector3d> axes{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                                      Eigen::Vector3d::UnitZ()};
    if (settings_.planar) axes = {Eigen::Vector3d::UnitZ()};
    if (const auto rod = rod_from(side, link.joint); rod && !settings_.planar) {
      const auto [first, second] = across(chains_.bodies[side.to].linear() * *rod);
      axes = {first, second};
    }
    link.kind = Kind::revolute;
    const std::string name = link.name;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (i > 0) {
        link.parent = static_cast<int>(chains_.legs[leg].links.size()) - 1;
        link.coordinate = chains_.legs[leg].coordinates++;
      }
      if (axes.size() > 1) link.name = name + "_" + std::to_string(i + 1);
      link.axis = axes[i];
      chains_.legs[leg].links.push_back(link);
    }
  }

  // From ball to ball, in the body.
  std::optional<Eigen::Vector3d> rod_from(const Side& side, std::size_t of) const {
    std::optional<Eigen::Vector3d> rod;
    for (std::size_t j = 0; j < graph_.joints.size(); ++j) {
      const GraphJoint& joint = graph_.joints[j];
      if (j == of || (joint.parent != side.to && joint.child != side.to)) continue;
      if (rod || joint.kind != Kind::spherical) return std::nullopt;
      rod = side_of(joint, side.to).near.translation() - side.far.translation();
    }
    if (!rod || rod->norm() < 1e-9) return std::nullopt;
    return rod;
  }

  // By the first joint that leads to it.
  void place_platform() {
    const std::size_t body = chains_.platform_body;
    for (const GraphJoint& joint : graph_.joints) {
      if (placed_[body] || (joint.parent != body && joint.child != body)) continue;
      const Side side = side_of(joint, joint.parent == body ? joint.child : joint.parent);
      if (!placed_[side.from]) continue;
      chains_.bodies[body] = frame_of(side) * side.far.inverse();
      placed_[body] = true;
    }
    if (!placed_[body])
      graph_.refuse("no joint leads to the platform, '" + graph_.bodies[body].name +
                    "'; name the pairs of frames that hold it by --closures FILE");
    if (settings_.planar) turn_into_plane();
    chains_.platform = chains_.bodies[body] * chains_.frame_in_body;
  }

  // E's third axis is that of the base: where it is not, all three are as long as nothing has moved.
  void turn_into_plane() {
    const Eigen::Matrix3d body = chains_.bodies[chains_.platform_body].linear();
    const Eigen::Matrix3d axes = body * chains_.frame_in_body.linear();
    Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
    if (axes(2, 2) > 1.0 - 1e-9)
      turned =
          Eigen::AngleAxisd(std::atan2(axes(1, 0), axes(0, 0)), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    chains_.frame_in_body.linear() = body.transpose() * turned;
  }

  void close(std::size_t leg) {
    for (std::size_t j = 0; j < graph_.joints.size(); ++j) {
      const GraphJoint& joint = graph_.joints[j];
      if (used_[j] || (leg_of_[joint.parent] != leg && leg_of_[joint.child] != leg)) continue;
      used_[j] = true;
      add_join(leg, j, side_of(joint, leg_of_[joint.parent] == leg ? joint.parent : joint.child));
    }
  }

  // A passive leg of one joint.
  void join_base_and_platform() {
    for (std::size_t j = 0; j < graph_.joints.size(); ++j) {
      if (used_[j]) continue;
      const GraphJoint& joint = graph_.joints[j];
      if (joint.kind == Kind::spherical)
        graph_.refuse("joint '" + joint.name +
                      "' holds a point of the platform on the base, about which it could only turn");
      chains_.legs.emplace_back();
      add_hinge(chains_.legs.size() - 1, j, side_of(joint, graph_.base));
    }
  }

  void add_join(std::size_t leg, std::size_t j, const Side& side) {
    const GraphJoint& joint = graph_.joints[j];
    const bool is_point =
        joint.kind == Kind::spherical || (settings_.planar && joint.kind == Kind::revolute && !joint.driven);
    if (!is_point) return add_hinge(leg, j, side);
    ChainJoin join;
    join.link = static_cast<std::size_t>(link_of_[side.from]);
    join.at = in_link(chains_.legs[leg].links[join.link], frame_of(side));
    set_other_side(leg, side, join);
    chains_.legs[leg].joins.push_back(join);
  }

  // A joint that carries nothing, whose frame is held.
  void add_hinge(std::size_t leg, std::size_t j, const Side& side) {
    ChainLeg& of = chains_.legs[leg];
    of.links.push_back(link_at(leg, j, side));
    ChainJoin join;
    join.link = of.links.size() - 1;
    join.at = in_link(of.links.back(), frame_of(side));
    join.holds_frame = true;
    set_other_side(leg, side, join);
    of.joins.push_back(join);
  }

  Eigen::Isometry3d in_link(const ChainLink& link, Eigen::Isometry3d frame) const {
    frame.translation() = flat(frame.translation()) - link.origin;
    return frame;
  }

  void set_other_side(std::size_t leg, const Side& side, ChainJoin& join) const {
    if (side.to == chains_.platform_body) {
      join.on = ChainJoin::On::platform;
      join.on_at = chains_.frame_in_body.inverse() * side.far;
      return;
    }
    const Eigen::Isometry3d frame = chains_.bodies[side.to] * side.far;
    if (side.to == graph_.base) {
      join.on = ChainJoin::On::base;
      join.on_at = frame;
      join.on_at.translation() = flat(frame.translation());
      return;
    }
    join.on = ChainJoin::On::link;
    join.on_link = static_cast<std::size_t>(link_of_[side.to]);
    join.on_at = in_link(chains_.legs[leg].links[join.on_link], frame);
  }

  // As the model has their first joints.
  void order_legs() {
    std::stable_sort(chains_.legs.begin(), chains_.legs.end(), [](const ChainLeg& a, const ChainLeg& b) {
      return a.links.front().joint < b.links.front().joint;
    });
  }

  void resolve_followers() {
    for (ChainLeg& leg : chains_.legs) {
      for (std::size_t l = 0; l < leg.links.size(); ++l) {
        const GraphJoint& joint = graph_.joints[leg.links[l].joint];
        if (joint.follows) resolve(leg, l, joint);
      }
      renumber(leg);
    }
  }

  void resolve(ChainLeg& leg, std::size_t l, const GraphJoint& joint) const {
    const GraphJoint& leader = graph_.joints[graph_.joint(joint.follows->joint)];
    for (std::size_t k = 0; k < leg.links.size(); ++k) {
      if (&graph_.joints[leg.links[k].joint] != &leader) continue;
      if (k >= l)
        graph_.refuse("joint '" + joint.name + "' follows '" + leader.name +
                      "', which comes after it from the base; let that one follow it instead");
      ChainLink& link = leg.links[l];
      link.follows = static_cast<int>(k);
      link.coordinate = leg.links[k].coordinate;
      // q + zero = ratio (q_leader + zero_leader) + offset
      const double offset = joint.follows->ratio * leader.zero + joint.follows->offset - joint.zero;
      link.ratio = joint.follows->ratio * leg.links[k].ratio;
      link.offset = joint.follows->ratio * leg.links[k].offset + offset;
      return;
    }
    graph_.refuse("joint '" + joint.name + "' follows '" + leader.name +
                  "', which is not of the same leg; only joints of one leg can be coupled");
  }

  static void renumber(ChainLeg& leg) {
    std::vector<int> number(static_cast<std::size_t>(leg.coordinates), -1);
    int next = 0;
    for (ChainLink& link : leg.links) {
      int& of = number[static_cast<std::size_t>(link.coordinate)];
      if (of < 0) of = next++;
      link.coordinate = of;
    }
    leg.coordinates = next;
  }

  const BodyGraph& graph_;
  const ChainSettings& settings_;
  ClosedChains chains_;
  std::size_t components_ = 0;
  std::vector<std::size_t> leg_of_;  // of each body
  std::vector<int> link_of_;         // of each body, in its leg
  std::vector<bool> placed_, used_;
};

}  // namespace

int ClosedChains::coordinates() const {
  int sum = 0;
  for (const ChainLeg& leg : legs) sum += leg.coordinates;
  return sum;
}

ClosedChains closed_chains(const BodyGraph& graph, const ChainSettings& settings) {
  return ChainBuilding(graph, settings).build();
}

}  // namespace flinch
