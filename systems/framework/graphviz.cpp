// Diagram::graphviz(): the picture of a diagram.
#include <sstream>
#include <unordered_map>

#include "systems/framework/diagram.h"

namespace flinch {
namespace {

/// Gives every block and diagram a short identifier, in the order of drawing, so that equal diagrams give
/// equal text.
class Drawing {
 public:
  std::string draw(const Diagram& root) {
    text_ << "digraph \"" << root.name()
          << "\" {\n  rankdir=LR;\n  node [shape=plain, fontname=\"Helvetica\", fontsize=11];\n"
          << "  edge [color=\"#4a5a70\", arrowsize=0.7];\n  compound=true;\n";
    draw_ports(root, "  ");
    draw_children(root, "  ");
    draw_wires(root);
    text_ << "}\n";
    return text_.str();
  }

 private:
  const std::string& id(const System& block) {
    auto [entry, is_new] = ids_.try_emplace(&block);
    if (is_new) entry->second = "b" + std::to_string(ids_.size());
    return entry->second;
  }

  /// The inputs and outputs of a diagram are small nodes of their own.
  void draw_ports(const Diagram& diagram, const std::string& indent) {
    for (std::size_t i = 0; i < diagram.inputs().size(); ++i)
      draw_port(diagram, "i", i, diagram.inputs()[i].name, indent);
    for (std::size_t i = 0; i < diagram.outputs().size(); ++i)
      draw_port(diagram, "o", i, diagram.outputs()[i].name, indent);
  }

  void draw_port(const Diagram& diagram, const char* side, std::size_t i, const std::string& name,
                 const std::string& indent) {
    text_ << indent << id(diagram) << "_" << side << i
          << " [shape=box, style=\"rounded,filled\", fillcolor=\"#e8eef7\", label=\"" << name << "\"];\n";
  }

  void draw_children(const Diagram& diagram, const std::string& indent) {
    for (const auto& child : diagram.children()) {
      if (const auto* nested = dynamic_cast<const Diagram*>(child.get())) {
        text_ << indent << "subgraph cluster_" << id(*nested) << " {\n"
              << indent << "  label=\"" << nested->name()
              << "\"; style=rounded; color=\"#9aa8ba\"; fontname=\"Helvetica\";\n";
        draw_ports(*nested, indent + "  ");
        draw_children(*nested, indent + "  ");
        text_ << indent << "}\n";
      } else {
        draw_block(*child, indent);
      }
    }
  }

  void draw_block(const System& block, const std::string& indent) {
    std::vector<std::size_t> shown;  // intermediate results are no ports
    for (std::size_t i = 0; i < block.outputs().size(); ++i) {
      if (!block.outputs()[i].intermediate) shown.push_back(i);
    }
    const std::size_t rows = std::max<std::size_t>({block.inputs().size(), shown.size(), 1});
    text_ << indent << id(block)
          << " [label=<<table border=\"1\" cellborder=\"0\" cellspacing=\"0\" cellpadding=\"3\" "
             "color=\"#4a5a70\">"
          << "<tr><td colspan=\"2\" bgcolor=\"#f3f1ea\"><b>" << block.name() << "</b></td></tr>";
    for (std::size_t i = 0; i < rows; ++i) {
      const std::size_t output = i < shown.size() ? shown[i] : block.outputs().size();
      text_ << "<tr>" << cell("i", i, block.inputs(), "left") << cell("o", output, block.outputs(), "right")
            << "</tr>";
    }
    text_ << "</table>>];\n";
  }

  template <class Ports>
  static std::string cell(const char* side, std::size_t i, const Ports& ports, const char* align) {
    if (i >= ports.size()) return "<td></td>";
    return std::string("<td port=\"") + side + std::to_string(i) + "\" align=\"" + align + "\">" +
           ports[i].name + "</td>";
  }

  void draw_wires(const Diagram& diagram) {
    for (const Diagram::Wire& wire : diagram.wires()) draw_edge(wire.from, wire.to);
    for (std::size_t i = 0; i < diagram.outputs().size(); ++i) {
      draw_edge(diagram.outputs()[i].reads.front(), {&diagram, PortId::Kind::output, static_cast<int>(i)});
    }
    for (const auto& child : diagram.children()) {
      if (const auto* nested = dynamic_cast<const Diagram*>(child.get())) draw_wires(*nested);
    }
  }

  void draw_edge(PortId from, PortId to) {
    text_ << "  " << anchor(from, ":e") << " -> " << anchor(to, ":w") << ";\n";
  }

  std::string anchor(PortId port, const char* compass) {
    const std::string side = port.kind == PortId::Kind::input ? "i" : "o";
    const bool of_diagram = dynamic_cast<const Diagram*>(port.owner) != nullptr;
    return id(*port.owner) + (of_diagram ? "_" : ":") + side + std::to_string(port.index) +
           (of_diagram ? "" : compass);
  }

  std::unordered_map<const System*, std::string> ids_;
  std::ostringstream text_;
};

}  // namespace

std::string Diagram::graphviz() const { return Drawing().draw(*this); }

}  // namespace flinch
