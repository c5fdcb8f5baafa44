#include "convert/home_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "convert/platform_motion.h"
#include "systems/robot/angles.h"

namespace flinch {
namespace {

constexpr double far_enough = 0.15;  // from singularities
constexpr int draws = 200;
constexpr double widest = 1.2;  // of angles that are drawn [rad]

double position(const ChainLink& link, const Eigen::VectorXd& s) {
  return link.ratio * s[link.coordinate] + link.offset;
}

/// Calls `visit(link, position)` for each link of a state.
template <class Visit>
void for_each_link(const ClosedChains& chains, const ChainState& state, Visit visit) {
  for (std::size_t i = 0; i < chains.legs.size(); ++i) {
    for (const ChainLink& link : chains.legs[i].links) visit(link, position(link, state.s[i]));
  }
}

/// The first joint that stands outside of its range; "" where none does.
std::string outside(const BodyGraph& graph, const ClosedChains& chains, const ChainState& state) {
  std::string name;
  for_each_link(chains, state, [&](const ChainLink& link, double q) {
    const GraphJoint& joint = graph.joints[link.joint];
    const double shown = (link.slides() ? q : wrap_angle(q)) + joint.zero;
    const bool within = shown > joint.least && shown < joint.most;
    if (name.empty() && !within && joint.kind != GraphJoint::Kind::spherical) name = link.name;
  });
  return name;
}

void wrap_angles(const ClosedChains& chains, ChainState& state) {
  for (std::size_t i = 0; i < chains.legs.size(); ++i) {
    for (const ChainLink& link : chains.legs[i].links) {
      double& s = state.s[i][link.coordinate];
      if (link.kind == GraphJoint::Kind::revolute && link.follows < 0) s = wrap_angle(s);
    }
  }
}

class HomeSearch {
 public:
  HomeSearch(const BodyGraph& graph, const ClosedChains& chains, double length, double tolerance)
      : graph_(graph), chains_(chains), length_(length), tolerance_(tolerance) {}

  FoundHome find(const std::map<std::string, double>& guess) {
    const ChainState start = guessed(guess);
    std::string outside_at_start;
    const auto nearest = closed(chains_, start, tolerance_);
    if (nearest) {
      outside_at_start = outside(graph_, chains_, *nearest);
      take(*nearest);
    }
    if (best_.distance_from_singularities > far_enough) return best_;
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < draws; ++i) {
      ChainState drawn = start;
      const double wide = widest * (i + 1) / draws;
      for (std::size_t leg = 0; leg < chains_.legs.size(); ++leg) {
        for (const ChainLink& link : chains_.legs[leg].links)
          drawn.s[leg][link.coordinate] += uniform(generator) * wide * (link.slides() ? length_ : 1.0);
      }
      if (const auto found = closed(chains_, drawn, tolerance_)) take(*found);
      if (best_.distance_from_singularities > 2.0 * far_enough) break;
    }
    best_.searched = true;
    if (found_) return best_;
    if (nearest)
      graph_.refuse("joint '" + outside_at_start +
                    "' stands outside of its range where the loops close; name "
                    "about where joints are at home by --guess JOINT=DEGREES");
    graph_.refuse("the loops do not close from the zero of the joints: " + widest_gap(start) +
                  "; check the frames of the closures, or name about where joints are at home by --guess "
                  "JOINT=DEGREES");
  }

 private:
  ChainState guessed(const std::map<std::string, double>& guess) const {
    ChainState state = resting_state(chains_);
    for (const auto& [name, value] : guess) {
      const GraphJoint& joint = graph_.joints[graph_.joint(name)];
      for (std::size_t i = 0; i < chains_.legs.size(); ++i) {
        for (const ChainLink& link : chains_.legs[i].links) {
          if (&graph_.joints[link.joint] == &joint && link.follows < 0)
            state.s[i][link.coordinate] = value - joint.zero;
        }
      }
    }
    return state;
  }

  void take(ChainState state) {
    wrap_angles(chains_, state);
    if (!outside(graph_, chains_, state).empty()) return;
    const double distance = distance_from_singularities(graph_, chains_, state, length_);
    if (found_ && distance <= best_.distance_from_singularities) return;
    found_ = true;
    best_.state = state;
    best_.distance_from_singularities = distance;
  }

  std::string widest_gap(const ChainState& state) const {
    const ClosureRows rows = closure_rows(chains_, state);
    std::size_t widest_leg = 0;
    double widest_gap = 0.0;
    for (std::size_t i = 0; i < chains_.legs.size(); ++i) {
      const int first = rows.first_row[i];
      const int count = rows.first_row[i + 1] - first;
      const double gap = count == 0 ? 0.0 : rows.e.segment(first, count).norm();
      if (gap < widest_gap) continue;
      widest_gap = gap;
      widest_leg = i;
    }
    return "the leg of joint '" + chains_.legs[widest_leg].links.front().name + "' is open there by " +
           std::to_string(1e3 * widest_gap) + " mm";
  }

  const BodyGraph& graph_;
  const ClosedChains& chains_;
  double length_, tolerance_;
  FoundHome best_;
  bool found_ = false;
};

}  // namespace

FoundHome find_home(const BodyGraph& graph, const ClosedChains& chains,
                    const std::map<std::string, double>& guess, double length, double tolerance) {
  return HomeSearch(graph, chains, length, tolerance).find(guess);
}

ChainState same_state(const ClosedChains& from, const ChainState& state, const ClosedChains& to) {
  std::map<std::string, double> positions;
  for (std::size_t i = 0; i < from.legs.size(); ++i) {
    for (const ChainLink& link : from.legs[i].links) positions[link.name] = state.s[i][link.coordinate];
  }
  ChainState result = resting_state(to);
  for (std::size_t i = 0; i < to.legs.size(); ++i) {
    for (const ChainLink& link : to.legs[i].links) {
      const auto found = positions.find(link.name);
      if (found != positions.end() && link.follows < 0) result.s[i][link.coordinate] = found->second;
    }
  }
  // How the base frames are turned against one another, and E against E.
  const Eigen::Matrix3d turned = to.bodies[0].linear() * from.bodies[0].linear().transpose();
  const Eigen::Isometry3d body = state.platform * from.frame_in_body.inverse();
  result.platform = Eigen::Isometry3d(turned) * body * to.frame_in_body;
  if (to.planar) result.platform.translation().z() = 0.0;
  return result;
}

double characteristic_length(const ClosedChains& chains) {
  double held = 0.0;
  double reach = 0.0;
  int count = 0;
  for (const ChainLeg& leg : chains.legs) {
    for (const ChainJoin& join : leg.joins) {
      if (join.on != ChainJoin::On::platform) continue;
      const Eigen::Vector3d& on = join.on_at.translation();
      held += chains.planar ? on.head<2>().norm() : on.norm();
      reach += (chains.platform * on - leg.links.front().origin).norm();
      ++count;
    }
  }
  if (count == 0) return 1.0;
  const double length = std::max(held / count, reach / count / 3.0);
  return length > 1e-6 ? length : 1.0;
}

}  // namespace flinch
