#include "systems/framework/diagram_levels.h"

#include <sstream>

#include "systems/framework/dot_text.h"

namespace flinch {
namespace {

/// Draws the levels of one diagram.
class LevelDrawing {
 public:
  explicit LevelDrawing(const Diagram& root) : paths_(root) {}

  void draw(const Diagram& level, std::vector<DiagramLevel>& levels) const {
    std::ostringstream text;
    text << dot_head(level.name());
    draw_own_ports(level.inputs(), {&level, PortId::Kind::input}, text);
    draw_own_ports(level.outputs(), {&level, PortId::Kind::output}, text);
    for (const auto& child : level.children()) draw_box(*child, text);
    for (const Diagram::Wire& wire : wires_to_outputs(level)) draw_wire(level, wire, text);
    text << "}\n";
    levels.push_back({paths_.of(level), text.str()});
    for (const auto& child : level.children()) {
      if (const auto* nested = dynamic_cast<const Diagram*>(child.get())) draw(*nested, levels);
    }
  }

 private:
  template <class Ports>
  void draw_own_ports(const Ports& ports, PortId first, std::ostringstream& text) const {
    for (std::size_t i = 0; i < ports.size(); ++i) {
      const PortId port{first.owner, first.kind, static_cast<int>(i)};
      text << "  " << anchor(*first.owner, port) << " [id=\"port:" << paths_.of(port) << "\", "
           << dot_port(ports[i].name) << "];\n";
    }
  }

  void draw_box(const System& block, std::ostringstream& text) const {
    text << "  \"" << paths_.of(block) << "\" [id=\"block:" << paths_.of(block) << "\", label=<"
         << dot_table(block) << ">];\n";
  }

  void draw_wire(const Diagram& level, const Diagram::Wire& wire, std::ostringstream& text) const {
    text << "  " << anchor(level, wire.from) << (wire.from.owner == &level ? "" : ":e") << " -> "
         << anchor(level, wire.to) << (wire.to.owner == &level ? "" : ":w") << " [id=\""
         << paths_.of(wire.from) << ">" << paths_.of(wire.to) << "\"];\n";
  }

  /// The ports of the level are nodes of their own, those of its blocks cells of theirs.
  std::string anchor(const System& level, PortId port) const {
    if (port.owner == &level) return "own_" + dot_cell(port);
    return "\"" + paths_.of(*port.owner) + "\":" + dot_cell(port);
  }

  PortPaths paths_;
};

}  // namespace

std::vector<DiagramLevel> levels_of(const Diagram& root) {
  std::vector<DiagramLevel> levels;
  LevelDrawing(root).draw(root, levels);
  return levels;
}

PortPaths::PortPaths(const Diagram& root) {
  paths_.emplace(&root, "");
  add(root);
}

void PortPaths::add(const Diagram& diagram) {
  const std::string prefix = of(diagram).empty() ? "" : of(diagram) + "/";
  for (const auto& child : diagram.children()) {
    paths_.emplace(child.get(), prefix + child->name());
    if (const auto* nested = dynamic_cast<const Diagram*>(child.get())) add(*nested);
  }
}

std::string PortPaths::of(PortId port) const {
  const std::string& block = of(*port.owner);
  return (block.empty() ? "" : block + "/") + port.owner->port_name(port);
}

}  // namespace flinch
