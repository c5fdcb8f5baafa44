#include "systems/framework/diagram_levels.h"

#include <algorithm>
#include <sstream>

namespace flinch {
namespace {

/// Draws the levels of one diagram.
class LevelDrawing {
 public:
  explicit LevelDrawing(const Diagram& root) : paths_(root) {}

  void draw(const Diagram& level, std::vector<DiagramLevel>& levels) const {
    std::ostringstream text;
    text << "digraph \"" << level.name()
         << "\" {\n  rankdir=LR;\n  node [shape=plain, fontname=\"Helvetica\", fontsize=11];\n"
         << "  edge [color=\"#4a5a70\", arrowsize=0.7];\n";
    draw_own_ports(level.inputs(), {&level, PortId::Kind::input}, text);
    draw_own_ports(level.outputs(), {&level, PortId::Kind::output}, text);
    for (const auto& child : level.children()) draw_box(*child, text);
    for (const Diagram::Wire& wire : level.wires()) draw_wire(level, wire, text);
    for (std::size_t i = 0; i < level.outputs().size(); ++i) {
      const PortId out{&level, PortId::Kind::output, static_cast<int>(i)};
      draw_wire(level, {level.outputs()[i].reads.front(), out}, text);
    }
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
      text << "  " << anchor(*first.owner, port) << " [id=\"port:" << paths_.of(port)
           << "\", shape=box, style=\"rounded,filled\", fillcolor=\"#e8eef7\", label=\"" << ports[i].name
           << "\"];\n";
    }
  }

  void draw_box(const System& block, std::ostringstream& text) const {
    std::vector<std::size_t> shown;  // intermediate results are no ports
    for (std::size_t i = 0; i < block.outputs().size(); ++i) {
      if (!block.outputs()[i].intermediate) shown.push_back(i);
    }
    const bool opens = dynamic_cast<const Diagram*>(&block) != nullptr;
    text << "  \"" << paths_.of(block) << "\" [id=\"block:" << paths_.of(block)
         << "\", label=<<table border=\"" << (opens ? 2 : 1)
         << "\" cellborder=\"0\" cellspacing=\"0\" cellpadding=\"3\" color=\"#4a5a70\">"
         << "<tr><td colspan=\"2\" bgcolor=\"" << (opens ? "#dfe7f2" : "#f3f1ea") << "\"><b>" << block.name()
         << "</b></td></tr>";
    const std::size_t rows = std::max<std::size_t>({block.inputs().size(), shown.size(), 1});
    for (std::size_t i = 0; i < rows; ++i) {
      text << "<tr>";
      draw_cell(block, PortId::Kind::input, i, block.inputs(), text);
      draw_cell(block, PortId::Kind::output, i < shown.size() ? shown[i] : block.outputs().size(),
                block.outputs(), text);
      text << "</tr>";
    }
    text << "</table>>];\n";
  }

  template <class Ports>
  void draw_cell(const System& block, PortId::Kind kind, std::size_t i, const Ports& ports,
                 std::ostringstream& text) const {
    if (i >= ports.size()) {
      text << "<td></td>";
      return;
    }
    const PortId port{&block, kind, static_cast<int>(i)};
    text << "<td port=\"" << name_of_cell(port) << "\" align=\""
         << (kind == PortId::Kind::input ? "left" : "right") << "\">" << ports[i].name << "</td>";
  }

  void draw_wire(const Diagram& level, const Diagram::Wire& wire, std::ostringstream& text) const {
    text << "  " << anchor(level, wire.from) << (wire.from.owner == &level ? "" : ":e") << " -> "
         << anchor(level, wire.to) << (wire.to.owner == &level ? "" : ":w") << " [id=\""
         << paths_.of(wire.from) << ">" << paths_.of(wire.to) << "\"];\n";
  }

  static std::string name_of_cell(PortId port) {
    return (port.kind == PortId::Kind::input ? "i" : "o") + std::to_string(port.index);
  }

  /// The ports of the level are nodes of their own, those of its blocks cells of theirs.
  std::string anchor(const System& level, PortId port) const {
    if (port.owner == &level) return "own_" + name_of_cell(port);
    return "\"" + paths_.of(*port.owner) + "\":" + name_of_cell(port);
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
