// Diagram::graphviz(): the picture of a diagram.
#include <sstream>
#include <unordered_map>

#include "systems/framework/diagram.h"
#include "systems/framework/dot_text.h"

namespace flinch {
namespace {

/// Gives every block and diagram a short identifier, in the order of drawing, so that equal diagrams give
/// equal text.
class Drawing {
 public:
  std::string draw(const Diagram& root) {
    text_ << dot_head(root.name()) << "  compound=true;\n";
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
    text_ << indent << id(diagram) << "_" << side << i << " [" << dot_port(name) << "];\n";
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
        text_ << indent << id(*child) << " [label=<" << dot_table(*child) << ">];\n";
      }
    }
  }

  void draw_wires(const Diagram& diagram) {
    for (const Diagram::Wire& wire : wires_to_outputs(diagram)) draw_edge(wire.from, wire.to);
    for (const auto& child : diagram.children()) {
      if (const auto* nested = dynamic_cast<const Diagram*>(child.get())) draw_wires(*nested);
    }
  }

  void draw_edge(PortId from, PortId to) {
    text_ << "  " << anchor(from, ":e") << " -> " << anchor(to, ":w") << ";\n";
  }

  std::string anchor(PortId port, const char* compass) {
    const bool of_diagram = dynamic_cast<const Diagram*>(port.owner) != nullptr;
    return id(*port.owner) + (of_diagram ? "_" : ":") + dot_cell(port) + (of_diagram ? "" : compass);
  }

  std::unordered_map<const System*, std::string> ids_;
  std::ostringstream text_;
};

}  // namespace

std::string Diagram::graphviz() const { return Drawing().draw(*this); }

}  // namespace flinch
