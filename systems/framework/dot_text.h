#pragma once

#include <string>
#include <vector>

#include "systems/framework/diagram.h"

namespace flinch {

// Pieces in Graphviz' DOT language of which all pictures of diagrams are made.

/// The beginning of a picture, up to its first node.
std::string dot_head(const std::string& name);

/// The attributes of a node that stands for a port of a diagram, without brackets.
std::string dot_port(const std::string& name);

/// The name of the cell of a port in its block's table: "i0", "o2".
std::string dot_cell(PortId port);

/// The label of a block: a table of its name, its inputs at the left and its outputs at the right. A diagram,
/// drawn as a block, has a thicker border and a darker title.
std::string dot_table(const System& block);

/// The wires of a diagram, then those that end at its own outputs.
std::vector<Diagram::Wire> wires_to_outputs(const Diagram& diagram);

}  // namespace flinch
