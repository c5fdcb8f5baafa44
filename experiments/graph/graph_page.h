#pragma once

#include <functional>
#include <string>

#include "systems/framework/diagram.h"

namespace flinch {

/// What a page says of its diagram.
struct GraphFacts {
  std::string name;  ///< of the scenario
  std::string call;  ///< the command that made the page
};

/// The picture of a graph in DOT, as SVG.
using DrawGraph = std::function<std::string(const std::string& dot)>;

/// One HTML page that needs nothing else: a tree of blocks that folds and is searched, the picture of one
/// level at a time, and for each block its ports with what they hold, in which unit, whence and where to.
std::string graph_page(const Diagram& diagram, const GraphFacts& facts, const DrawGraph& draw);

}  // namespace flinch
