#pragma once

#include <map>
#include <string>
#include <vector>

#include "convert/body_graph.h"
#include "convert/chain_motion.h"
#include "convert/closed_chains.h"

namespace flinch {

/// A home, and whether it had to be looked for.
struct FoundHome {
  ChainState state;
  bool searched = false;  ///< The zero of the model, or the guess, is singular.
  double distance_from_singularities = 0.0;
};

/// The state with closed loops that is nearest to the zero of the model, or to `guess` [rad or m]. Where that
/// is singular, as the stretched zero of CAD programs, the best of many that are drawn around it, always the
/// same. Throws SetupError through `graph` where loops do not close, or only outside of ranges.
FoundHome find_home(const BodyGraph& graph, const ClosedChains& chains,
                    const std::map<std::string, double>& guess, double length, double tolerance);

/// The state of `to` where joints of the same names stand as in `from`.
ChainState same_state(const ClosedChains& from, const ChainState& state, const ClosedChains& to);

/// The length at which an angle counts as much as a distance: from E to where legs hold the platform in the
/// mean, and a third of the way from the base to there at least [m].
double characteristic_length(const ClosedChains& chains);

}  // namespace flinch
