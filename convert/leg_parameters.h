#pragma once

#include <string>
#include <vector>

#include "convert/body_graph.h"
#include "convert/chain_motion.h"
#include "convert/closed_chains.h"
#include "systems/robot/legs/legs_parameters.h"

namespace flinch {

/// Base, platform and legs of `chains` as the kind `legs` describes them, with `home` as home and reference.
/// Legs without mass, drive and friction that only guide the platform are left out where `moves` says the
/// same. Where a model has no shape for what can be touched, a simple one stands in. Both go into `notes`.
LegsParameters leg_parameters(const BodyGraph& graph, const ClosedChains& chains, const ChainState& home,
                              const PlatformMoves& moves, std::vector<std::string>& notes);

}  // namespace flinch
