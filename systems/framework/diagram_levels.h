#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "systems/framework/diagram.h"

namespace flinch {

/// A picture of one diagram alone: the diagrams inside it are boxes, like blocks.
struct DiagramLevel {
  std::string path;  ///< Of the diagram: "control/estimators"; "" for the outermost.
  /// The picture in Graphviz' DOT language. Ids there: "block:" and the path of a box, "port:" and that of a
  /// port of the diagram itself, "FROM>TO" of a wire.
  std::string dot;
};

/// The levels of `root`, the outermost first and each before those inside it.
std::vector<DiagramLevel> levels_of(const Diagram& root);

/// The paths of all blocks and ports below a diagram: "station/encoders/joints"; of its own ports the names.
class PortPaths {
 public:
  explicit PortPaths(const Diagram& root);

  /// The path of a block or diagram; "" for `root`.
  const std::string& of(const System& block) const { return paths_.at(&block); }
  std::string of(PortId port) const;

 private:
  void add(const Diagram& diagram);

  std::unordered_map<const System*, std::string> paths_;
};

}  // namespace flinch
