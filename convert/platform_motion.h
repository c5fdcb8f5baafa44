#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "convert/body_graph.h"
#include "convert/chain_motion.h"
#include "convert/closed_chains.h"
#include "systems/robot/legs/platform_moves.h"

namespace flinch {

/// States in which closed chains are looked at, and the motions that their loops leave in each.
struct MotionSamples {
  std::vector<ChainState> states;
  std::vector<Eigen::MatrixXd> motions;  ///< As free_motions().
};

/// Home and `count` states near by, by small steps of random motions.
MotionSamples motion_samples(const ClosedChains& chains, const ChainState& home, double length, int count,
                             double tolerance);

/// Joints of the graph that none of the motions moves, though they could by themselves.
std::vector<std::size_t> frozen_joints(const ClosedChains& chains, const MotionSamples& samples);

/// Direction that all axes that turn have, across which all others slide; nothing where there is none.
std::optional<Eigen::Vector3d> plane_normal(const ClosedChains& chains, const ChainState& state);

/// The coordinates that motions of the platform have. Throws SetupError through `graph` where no robot has
/// them, or where joints can move while the platform stands still.
PlatformMoves platform_moves(const BodyGraph& graph, const ClosedChains& chains,
                             const MotionSamples& samples);

/// How far a state is from singularities, of legs and drives: 0 in one, 1 far from all.
double distance_from_singularities(const BodyGraph& graph, const ClosedChains& chains,
                                   const ChainState& state, double length);

}  // namespace flinch
