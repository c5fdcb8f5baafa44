#include "systems/framework/dot_text.h"

#include <algorithm>

namespace flinch {
namespace {

template <class Ports>
std::string cell(PortId port, const Ports& ports) {
  const auto i = static_cast<std::size_t>(port.index);
  if (i >= ports.size()) return "<td></td>";
  const char* const align = port.kind == PortId::Kind::input ? "left" : "right";
  return "<td port=\"" + dot_cell(port) + "\" align=\"" + align + "\">" + ports[i].name + "</td>";
}

}  // namespace

std::string dot_head(const std::string& name) {
  return "digraph \"" + name +
         "\" {\n  rankdir=LR;\n  node [shape=plain, fontname=\"Helvetica\", fontsize=11];\n"
         "  edge [color=\"#4a5a70\", arrowsize=0.7];\n";
}

std::string dot_port(const std::string& name) {
  return "shape=box, style=\"rounded,filled\", fillcolor=\"#e8eef7\", label=\"" + name + "\"";
}

std::string dot_cell(PortId port) {
  return (port.kind == PortId::Kind::input ? "i" : "o") + std::to_string(port.index);
}

std::string dot_table(const System& block) {
  std::vector<int> shown;  // intermediate results are no ports
  for (std::size_t i = 0; i < block.outputs().size(); ++i) {
    if (!block.outputs()[i].intermediate) shown.push_back(static_cast<int>(i));
  }
  const bool opens = dynamic_cast<const Diagram*>(&block) != nullptr;
  std::string text = "<table border=\"" + std::string(opens ? "2" : "1") +
                     "\" cellborder=\"0\" cellspacing=\"0\" cellpadding=\"3\" color=\"#4a5a70\">"
                     "<tr><td colspan=\"2\" bgcolor=\"" +
                     (opens ? "#dfe7f2" : "#f3f1ea") + "\"><b>" + block.name() + "</b></td></tr>";
  const std::size_t rows = std::max<std::size_t>({block.inputs().size(), shown.size(), 1});
  for (std::size_t i = 0; i < rows; ++i) {
    const int output = i < shown.size() ? shown[i] : static_cast<int>(block.outputs().size());
    text += "<tr>" + cell({&block, PortId::Kind::input, static_cast<int>(i)}, block.inputs()) +
            cell({&block, PortId::Kind::output, output}, block.outputs()) + "</tr>";
  }
  return text + "</table>";
}

std::vector<Diagram::Wire> wires_to_outputs(const Diagram& diagram) {
  std::vector<Diagram::Wire> wires = diagram.wires();
  for (std::size_t i = 0; i < diagram.outputs().size(); ++i) {
    wires.push_back(
        {diagram.outputs()[i].reads.front(), {&diagram, PortId::Kind::output, static_cast<int>(i)}});
  }
  return wires;
}

}  // namespace flinch
